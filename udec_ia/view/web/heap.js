// One state: the words of IA(), which of them belong together, and where each field stands. The field table
// tells everything; this file knows no field by its name.
//
// An address counts words from 1. A span is a stretch of words that belong together: a group, a junk group,
// words that nothing leads to, or those that are not used; it goes by its number, in order of address.

import { unpack, view } from "./numbers.js";

export class Heap {
  /** The state that Python wrote down. Promise. */
  static async open(table, state) {
    const names = ["words", "sizes", "kinds", "owners"];
    const parts = await Promise.all([...names.map((name) => state[name]), ...state.common].map(unpack));
    return new Heap(table, state, ...parts);
  }

  constructor(table, state, words, sizes, kinds, owners, ...common) {
    this.table = table;
    this.state = state;
    this.ratio = state.reals / state.ints;
    this.layout = table.layouts[this.ratio];
    this.ints = view(words, `i${state.ints}`);
    this.reals = view(words, `f${state.reals}`);
    this.common = {
      int: view(common[0], "i64"),
      real: view(common[1], `f${state.reals}`),
      double: view(common[2], "f64"),
    };
    this.kinds = view(kinds, "u8");
    this.owner = view(owners, "f64");
    this.first = new Float64Array(this.kinds.length + 1); // and where the last span ends
    this.first[0] = 1;
    view(sizes, "f64").forEach((size, k) => {
      this.first[k + 1] = this.first[k] + size;
    });
    this.groups = this.byKind();
  }

  /** Addresses of the groups of each kind, ascending. */
  byKind() {
    const groups = Object.fromEntries(this.table.spans.map((kind) => [kind, []]));
    this.kinds.forEach((kind, k) => groups[this.table.spans[kind]].push(this.first[k]));
    return groups;
  }

  // ---- spans

  /** Number of the span that a word belongs to; -1 if the page does not hold it. */
  spanOf(address) {
    const first = this.first;
    if (!(address >= 1 && address < first[first.length - 1])) return -1;
    let low = 0;
    let high = first.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (first[middle] <= address) low = middle;
      else high = middle;
    }
    return low;
  }

  /** Kind of a span: that of its group, or one of the table's words for the rest. */
  kind(span) {
    return this.table.spans[this.kinds[span]];
  }

  /** True if a span is a group in use. */
  isGroup(span) {
    return span >= 0 && this.kind(span) in this.table.kinds;
  }

  size(span) {
    return this.first[span + 1] - this.first[span];
  }

  /** True if a group of that kind begins at an address; a target may stand for several kinds. */
  holds(target, address) {
    const span = this.spanOf(address);
    if (span < 0 || this.first[span] !== address) return false;
    const kind = this.kind(span);
    return kind === target || (this.table.choices[target] ?? []).includes(kind);
  }

  // ---- words

  /** Fields of the group in a span, element by element: { field, name, element, first, last }. */
  words(span) {
    const kind = this.kind(span);
    const all = this.table.kinds[kind].fields.flatMap(elements);
    return all.map((one) => this.word(kind, one, this.first[span]));
  }

  /** One element of a field of the group of a kind at an address, with its words. */
  word(kind, one, address) {
    const wide = one.field.type === "int" ? 1 : this.ratio;
    const first = address + this.layout[kind].words[one.field.place] + one.element * wide;
    return { ...one, first, last: first + wide - 1 };
  }

  /** What a word holds: a number, a BigInt of 64 bits, or undefined if the page does not hold it. */
  value(word) {
    if (word.index !== undefined) return this.common[word.field.type][word.index];
    if (word.last > this.state.shown) return undefined;
    return word.field.type === "int" ? this.ints[word.first - 1] : this.reals[(word.first - 1) / this.ratio];
  }

  /** Variables of the common block, element by element: { field, name, element, index }. */
  variables() {
    return this.table.common
      .flatMap(elements)
      .map((one) => ({ ...one, index: one.field.place + one.element }));
  }

  /** A function that reads one field of the groups of a kind, by address, as a number; NaN if left out. */
  reader(kind, name) {
    const field = this.table.kinds[kind].fields.find((one) => one.name === name);
    const offset = this.layout[kind].words[field.place] - 1;
    const { ints, reals, ratio } = this;
    if (field.type === "int") return (address) => Number(ints[address + offset]);
    return (address) => reals[(address + offset) / ratio] ?? NaN;
  }

  /** A variable of the common block, as a number. */
  variable(name) {
    const field = this.table.common.find((one) => one.name === name);
    return Number(this.common[field.type][field.place]);
  }
}

/** A field, once for each of its elements, with their names: KXD, or KZG(2) for the second of several. */
export function elements(field) {
  return Array.from({ length: field.count }, (_, element) => {
    return { field, element, name: field.count > 1 ? `${field.name}(${element + 1})` : field.name };
  });
}
