// Numbers out of bytes. Python writes arrays as base64 of deflated bytes, little-endian; here they become
// typed arrays again. Integers of 64 bits stay exact: they are BigInt until somebody asks for an address.

export const ARRAYS = {
  u8: Uint8Array,
  i16: Int16Array,
  i32: Int32Array,
  i64: BigInt64Array,
  f32: Float32Array,
  f64: Float64Array,
};

/** The bytes that were packed into a text. */
export async function unpack(text) {
  const letters = atob(text);
  const bytes = new Uint8Array(letters.length);
  for (let k = 0; k < letters.length; k++) bytes[k] = letters.charCodeAt(k);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer();
}

/** The bytes of a buffer as numbers of one type, as many as there are wholly. */
export function view(buffer, type) {
  const Numbers = ARRAYS[type];
  return new Numbers(buffer, 0, Math.floor(buffer.byteLength / Numbers.BYTES_PER_ELEMENT));
}

/** An integer, or a real of so many bits, as text: all that tells it from the next one of its width. */
export function exact(value, bits) {
  if (Object.is(value, -0)) return "-0";
  if (bits === 32 && Number.isFinite(value) && !Number.isSafeInteger(value)) {
    for (let digits = 1; digits <= 9; digits++) {
      const short = Number(value.toPrecision(digits));
      if (Math.fround(short) === value) return String(short);
    }
  }
  return String(value);
}
