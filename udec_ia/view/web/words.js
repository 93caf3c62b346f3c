// Texts on spans and words: names, owners, what a value means, where a pointer leads, and who points
// to a group. The page's answers are those of `udec what` and `udec who`.

import { elements } from "./heap.js";

/** Addresses of the blocks that a group belongs to: two of a contact, none of a domain. */
export function owners(heap, span) {
  const kind = heap.kind(span);
  if (kind === "block") return [heap.first[span]];
  if (!heap.isGroup(span)) return [];
  const hosts = heap.words(span).filter((word) => word.field.role === "host");
  if (hosts.length) return hosts.map((word) => Number(heap.value(word)));
  return heap.owner[span] ? [heap.owner[span]] : [];
}

/** A span by name: block@88, junk@412, or its words. */
export function nameOf(heap, span) {
  const { junk } = heap.table;
  const kind = heap.kind(span);
  const first = heap.first[span];
  return heap.isGroup(span) || kind === junk
    ? `${kind}@${first}`
    : `${kind} ${first} to ${first + heap.size(span) - 1}`;
}

/** A span by name, with the blocks that it belongs to or the group that it lies behind; junk with its place. */
export function called(heap, span) {
  const name = nameOf(heap, span);
  if (heap.kind(span) === heap.table.junk) return `${name}, ${junkPlace(heap, span)}`;
  const behind = heap.table.kinds[heap.kind(span)]?.behind;
  if (behind) return `${name} of ${behind}@${heap.first[span] - heap.layout[behind].size}`;
  const blocks = owners(heap, span).map((ib) => (heap.holds("block", ib) ? `block@${ib}` : "no block"));
  return blocks.length && heap.kind(span) !== "block" ? `${name} of ${blocks.join(" and ")}` : name;
}

function junkPlace(heap, span) {
  const at = (one) => one.findIndex(([first]) => first === heap.first[span]);
  const chain = heap.state.chains.find((one) => at(one) >= 0);
  return `number ${at(chain) + 1} of ${chain.length} of ${chain[at(chain)][1]} words`;
}

/** How many there are of something: 1 word, 2 words. */
export function counted(n, what) {
  return `${n} ${what}${n === 1 ? "" : "s"}`;
}

/** What the value of a field says: { text, to, sound }; `to` is an address that can be gone to, or 0. */
export function meaning(heap, word, kind) {
  const { field } = word;
  const value = heap.value(word);
  if (value === undefined) return plain("left out of this page");
  if (field.target) return leadsTo(heap, field, Number(value));
  if (field.role === "head") {
    const head = heap.table.heads.find(([owner, code]) => owner === kind && code === Number(value));
    return head ? plain(head[2]) : { text: "no head code of its kind", to: 0, sound: false };
  }
  const number = Number(value);
  if (Number.isFinite(number) && isAllowed(field, number)) return plain(coded(heap, field, number));
  return { text: `${heap.table.notAllowed}, ${field.range}: ${field.text}`, to: 0, sound: false };
}

/** True if the table allows a field the number. */
function isAllowed(field, number) {
  const within = ([low, high]) => number >= low && (high === null || number <= high);
  return field.allowed.length === 0 || field.allowed.some(within);
}

/** The name of a code, or those of the flags that add up to it; the text of the table if there is none. */
function coded(heap, field, number) {
  const codes = heap.table.codes.filter(([name]) => name === field.name);
  const one = codes.find(([, code]) => code === number);
  if (one) return one[2];
  const flags = codes.filter(([, value, , flag]) => flag && (number & value) !== 0);
  const sum = flags.reduce((all, [, value]) => all + value, 0);
  return (sum === number && flags.map(([, , text]) => text).join(", ")) || field.text;
}

function plain(text) {
  return { text, to: 0, sound: true };
}

/** What a pointer leads to, or that it is not what the table says. */
export function leadsTo(heap, field, to) {
  const { target } = field;
  const kinds = heap.table.choices[target] ?? [target];
  const astray = `, no ${target === "any" ? "group" : kinds.join(" or ")}`;
  if (to === 0)
    return isAllowed(field, 0) ? plain("nothing") : { text: `nothing${astray}`, to: 0, sound: false };
  if (!(to >= 1 && to <= heap.state.top)) return { text: `outside IA()${astray}`, to: 0, sound: false };
  const span = heap.spanOf(to);
  if (span < 0) return plain(`${to}, left out of this page`);
  if (heap.holds(target, to)) return { text: called(heap, span), to, sound: true };
  const within = heap.first[span] === to ? "" : `word ${to - heap.first[span] + 1} of `;
  return { text: `${within}${called(heap, span)}${astray}`, to, sound: false };
}

/** All words that hold the address of a span: [{ span, name, first }]; span -1: the common block. */
export function whoPoints(heap, span) {
  const to = heap.first[span];
  const found = heap
    .variables()
    .filter((word) => word.field.target && Number(heap.value(word)) === to)
    .map((word) => ({ span: -1, name: word.name, first: 0 }));
  const wanted = heap.state.ints === 64 ? BigInt(to) : to;
  for (const [kind, { fields }] of Object.entries(heap.table.kinds)) {
    for (const one of fields.filter((field) => field.target).flatMap(elements)) {
      const offset = heap.word(kind, one, 0).first;
      for (const address of heap.groups[kind]) {
        if (heap.ints[address - 1 + offset] === wanted) {
          found.push({ span: heap.spanOf(address), name: one.name, first: address + offset });
        }
      }
    }
  }
  return found;
}

/** Spans that the pointers of a group lead to, each once. */
export function leadsFrom(heap, span) {
  if (!heap.isGroup(span)) return [];
  const pointers = heap.words(span).filter((word) => word.field.target);
  const spans = pointers.map((word) => heap.spanOf(Number(heap.value(word))));
  return [...new Set(spans.filter((one) => one >= 0))];
}

/** Spans of the groups that belong to the block in a span: corners, contacts, and what hangs on these. */
export function belongings(heap, span) {
  if (heap.kind(span) !== "block") return [];
  const block = heap.first[span];
  const kinds = Object.entries(heap.table.kinds).filter(([kind]) => kind !== "block");
  return kinds.flatMap(([kind, { fields }]) => {
    const hosts = fields
      .filter((field) => field.role === "host")
      .map((field) => heap.reader(kind, field.name));
    if (!hosts.length)
      return heap.groups[kind]
        .map((address) => heap.spanOf(address))
        .filter((one) => heap.owner[one] === block);
    return heap.groups[kind]
      .filter((address) => hosts.some((read) => read(address) === block))
      .map((address) => heap.spanOf(address));
  });
}

/** Addresses that a sentence of the checker names, as corner@412. */
export function named(message) {
  return [...message.matchAll(/\b[a-z]+@([0-9]+)/g)].map((match) => Number(match[1]));
}
