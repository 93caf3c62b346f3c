// What is typed into the search: an address (412), a group (block@88), a word of it (block@88.KXD, or through a
// pointer block@88.KP.KXP), a field (KXD), a kind (contacts), a condition (block where KXD > 0.1), or a variable
// of the common block (DTOL). The answer is a place to go to, a list, or a sentence that says why.

import { condition, kindNamed, path } from "./conditions.js";
import { elements } from "./heap.js";
import { called } from "./words.js";

/** { go, note }, { common }, { list } or { note }: where to go, or a list { title, kind, words, where }. */
export function find(heap, text) {
  const query = text.trim();
  if (/^[0-9]+$/.test(query)) return place(heap, Number(query), "");
  const group = /^([a-z-]+)@([0-9]+)(?:[.](.+))?$/i.exec(query);
  if (group) {
    const of = kindNamed(heap.table, group[1]) ?? group[1].toLowerCase();
    return group[3] ? word(heap, of, Number(group[2]), group[3]) : place(heap, Number(group[2]), of);
  }
  const kind = kindNamed(heap.table, query);
  if (kind) return { list: { title: kind, kind, words: [] } };
  const where = /^([a-z-]+)\s+where\s+(.+)$/is.exec(query);
  if (where) return matching(heap, where);
  return (
    field(heap, query) ?? {
      note: `no address, group, kind or field is called ${query}: try 1, block@1, contact or KXD`,
    }
  );
}

/** The groups of a kind that a condition is true for, with the fields that it names. */
function matching(heap, [title, typed, where]) {
  const kind = kindNamed(heap.table, typed);
  if (!kind) return { note: `${typed} is not a kind of group` };
  try {
    return { list: { title, kind, words: condition(heap, kind, where).columns, where } };
  } catch (error) {
    return { note: error.message };
  }
}

/** Where a field of a group stands, or one of the group that its pointers lead to. */
function word(heap, kind, address, fields) {
  const there = place(heap, address, kind);
  if (there.note) return there;
  try {
    const found = path(heap, kind, fields.toUpperCase().split(".")).read(address);
    if (found) return { go: found.first, note: "" };
  } catch (error) {
    return { note: error.message };
  }
  return { note: `a pointer of ${fields} leads to no such group` };
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
  const { kind, where } = list;
  const wanted = where ? condition(heap, kind, where) : null; // of this state: the list may be of another
  const words = wanted?.columns ?? list.words;
  const value = (one, address) => (one.read ? one.read(address) : heap.value(heap.word(kind, one, address)));
  const groups = wanted ? heap.groups[kind].filter(wanted.test) : heap.groups[kind];
  const found = groups.map((address) => ({ address, values: words.map((one) => value(one, address)) }));
  const key = (row) => (column === 0 ? row.address : row.values[column - 1]);
  const last = (row) => key(row) === undefined || Number.isNaN(key(row));
  const order = (a, b) => (key(a) < key(b) ? -1 : Number(key(a) > key(b)));
  return found.sort((a, b) => {
    return last(a) - last(b) || (falling ? order(b, a) : order(a, b)) || a.address - b.address;
  });
}
