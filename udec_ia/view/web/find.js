// What is typed into the search: an address (412), a group (block@88), a field (KXD), a kind (contact), or a
// variable of the common block (DTOL). The answer is a place to go to, a list, or a sentence that says why.

import { elements } from "./heap.js";
import { called } from "./words.js";

/** { go, note }, { common }, { list } or { note }: where to go, or a list { title, kind, words }. */
export function find(heap, text) {
  const query = text.trim();
  if (/^[0-9]+$/.test(query)) return place(heap, Number(query), "");
  const group = /^([a-z]+)@([0-9]+)$/i.exec(query);
  if (group) return place(heap, Number(group[2]), group[1].toLowerCase());
  const kind = query.toLowerCase();
  if (Object.hasOwn(heap.table.kinds, kind)) return { list: { title: kind, kind, words: [] } };
  return (
    field(heap, query) ?? {
      note: `no address, group, kind or field is called ${query}: try 1, block@1, contact or KXD`,
    }
  );
}

/** Where an address leads; with the kind of group that should be there. */
function place(heap, address, kind) {
  if (!(address >= 1 && address <= heap.state.top))
    return { note: `IA() has the addresses 1 to ${heap.state.top}` };
  const span = heap.spanOf(address);
  if (span < 0) return { note: `the words from ${heap.state.shown + 1} on are left out of this page` };
  if (!kind || heap.holds(kind, address)) return { go: address, note: "" };
  const begins = heap.first[span] === address;
  return {
    go: address,
    note: `no ${kind} begins at ${address}: it is ${begins ? "" : "in "}${called(heap, span)}`,
  };
}

/** A field of groups, which gives a list, or a variable of the common block; else undefined. */
function field(heap, query) {
  const name = query.toUpperCase();
  const meant = (one) => one.name === name || one.field.name === name;
  for (const [kind, { fields }] of Object.entries(heap.table.kinds)) {
    const words = fields
      .filter((one) => one.role !== "head")
      .flatMap(elements)
      .filter(meant);
    if (words.length) return { list: { title: name, kind, words } };
  }
  const variable = heap.variables().find(meant);
  return variable && { common: variable.name };
}

/** Rows of a list, { address, values }, in order of address or of a column; what is no number comes last. */
export function rows(heap, list, column, falling) {
  const { kind, words } = list;
  const found = heap.groups[kind].map((address) => {
    return { address, values: words.map((one) => heap.value(heap.word(kind, one, address))) };
  });
  const key = (row) => (column === 0 ? row.address : row.values[column - 1]);
  const last = (row) => key(row) === undefined || Number.isNaN(key(row));
  const order = (a, b) => (key(a) < key(b) ? -1 : Number(key(a) > key(b)));
  return found.sort((a, b) => {
    return last(a) - last(b) || (falling ? order(b, a) : order(a, b)) || a.address - b.address;
  });
}
