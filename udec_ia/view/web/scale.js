// Colours for numbers: what blocks, zones and domains have in a field, from the least to the greatest.

import { mixed } from "./drawing.js";
import { elements } from "./heap.js";

const STOPS = ["#30408f", "#2b83ba", "#7fc8a5", "#f4e285", "#e8793b", "#a5122a"]; // least to greatest
const SHADES = 60; // colours that can be distinguished
const EXTENSIONS = ["sdef", "fdef"]; // whose fields colour their block

/** What can be coloured by: kinds, and the elements of their fields. */
export function colourings(table) {
  return ["block", ...EXTENSIONS, "zone", "domain"].map((kind) => {
    const fields = table.kinds[kind].fields.filter((field) => field.role !== "head");
    return { kind, words: fields.flatMap(elements) };
  });
}

export class Scale {
  /** kind, name: of a field; its range is that of all groups in the state. */
  constructor(heap, kind, name) {
    const word = heap.table.kinds[kind].fields.flatMap(elements).find((one) => one.name === name);
    Object.assign(this, { heap, kind, word });
    const values = heap.groups[kind].map((address) => this.valueAt(address)).filter(Number.isFinite);
    this.low = values.reduce((a, b) => Math.min(a, b), Infinity);
    this.high = values.reduce((a, b) => Math.max(a, b), -Infinity);
  }

  valueAt(address) {
    return Number(this.heap.value(this.heap.word(this.kind, this.word, address)) ?? NaN);
  }

  /** True if shapes of a kind have colours by this scale. */
  isFor(kind) {
    return kind === (EXTENSIONS.includes(this.kind) ? "block" : this.kind);
  }

  /** What a shape has in the field; NaN if it has none. */
  value({ kind, address, extension }) {
    if (kind === this.kind) return this.valueAt(address);
    return extension && this.heap.holds(this.kind, extension) ? this.valueAt(extension) : NaN;
  }

  /** The colour of a shape, undefined if it has no value. */
  colour(shape) {
    const value = this.value(shape);
    if (!Number.isFinite(value)) return undefined;
    const share = this.high > this.low ? (value - this.low) / (this.high - this.low) : 0;
    return shade(Math.round(share * SHADES) / SHADES);
  }
}

/** The colour of a share of the range, from 0 to 1. */
function shade(share) {
  const k = Math.min(Math.floor(share * (STOPS.length - 1)), STOPS.length - 2);
  return mixed(STOPS[k + 1], STOPS[k], share * (STOPS.length - 1) - k);
}

/** All colours, as the background of an element has them. */
export function gradient() {
  return `linear-gradient(to right, ${STOPS.join(", ")})`;
}
