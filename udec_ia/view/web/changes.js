// What differs from the state before: the same addresses, other words. States of different word schemes have
// no word in common, and a group that has moved counts as another one.

/** The state before, if its words can be compared with those of a state; else null. */
export function comparable(heap, before) {
  const alike = before && before.state.ints === heap.state.ints && before.state.reals === heap.state.reals;
  return alike ? before : null;
}

/** True if any of the words of an address range has changed, or was not used before. */
export function changed(heap, before, first, last) {
  for (let address = first; address <= Math.min(last, heap.state.shown); address++) {
    if (heap.ints[address - 1] !== before.ints[address - 1]) return true; // undefined where none was used
  }
  return false;
}

/** What stood in a word of a group: the former value, or undefined if it was no such group. */
export function former(heap, before, span, word) {
  const was = before.spanOf(heap.first[span]);
  const same = was >= 0 && before.first[was] === heap.first[span] && before.kind(was) === heap.kind(span);
  return same ? before.value(word) : undefined;
}
