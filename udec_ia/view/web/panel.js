// The panel beside the heap: the fields of what is selected, who points there, what was found, what the
// checker says, and the deck. All text goes into the page as text. A link leads to an address in the heap,
// which is part of the page's own: so the browser's back and forward know it.

import { former } from "./changes.js";
import { styleName } from "./drawing.js";
import { rows } from "./find.js";
import { exact } from "./numbers.js";
import { called, counted, meaning, nameOf, named, whoPoints } from "./words.js";

const COMMON = "common"; // what goes for an address of the common block as a whole
const SHOWN = 500; // rows of a list
const RAW = 64; // words of what is no group

/** An element with properties and children, which are elements or text. */
export function element(tag, properties = {}, ...children) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}

/** A link to an address. */
export function link(address, text, state) {
  const made = element("a", { href: `#at=${address}&state=${state}` }, text);
  made.dataset.address = address;
  return made;
}

/** A small square in the colour of a kind. */
export function cell(kind) {
  const made = element("span", { className: `cell ${styleName(kind)}` });
  made.style.backgroundColor = `var(--${styleName(kind)}, var(--muted))`;
  return made;
}

export class Panel {
  /** found, chosen, about: elements; listed: called with the addresses in the list, none if it is closed. */
  constructor(found, chosen, about, listed) {
    Object.assign(this, { found, chosen, about, listed, list: null, column: 0, falling: false });
  }

  /** A state, by its number from 1 on, and the one before it or null. */
  show(heap, before, state) {
    Object.assign(this, { heap, before, state });
    this.showAbout();
    if (this.list) this.showList();
  }

  // ---- what is selected

  /** The span of an address, with its word; or the common block, where the variable `name` is marked. */
  choose(address, name) {
    const span = this.heap.spanOf(address);
    if (name !== undefined) this.chosen.replaceChildren(...this.commons(name));
    else if (span < 0) this.chosen.replaceChildren(...this.nothing(address));
    else this.chosen.replaceChildren(...this.group(span, address));
    this.chosen.querySelector("tr.word")?.scrollIntoView({ block: "nearest" });
  }

  nothing(address) {
    const { shown, top } = this.heap.state;
    if (address > shown && address <= top) return [element("p", {}, `${address} is left out of this page`)];
    if (address) return [element("p", {}, `There is no word ${address} in this state.`)];
    return [
      element(
        "p",
        { className: "muted" },
        "Click on a block, a corner, a contact or a space between blocks, " +
          "or on a cell of IA(). What is selected is marked on both sides, and its words stand here.",
      ),
    ];
  }

  group(span, address) {
    const { heap } = this;
    const [kind, first] = [heap.kind(span), heap.first[span]];
    const last = heap.first[span + 1] - 1;
    const text = heap.table.kinds[kind]?.text ?? "";
    const parts = [
      element("h2", {}, cell(kind), called(heap, span)),
      element(
        "p",
        { className: "muted" },
        `words ${first} to ${last} (${last - first + 1})${text && `, ${text}`}`,
      ),
      ...this.faultsOf(first),
    ];
    if (this.before && this.former(span) !== nameOf(heap, span)) {
      parts.push(element("p", {}, `In the state before: ${this.former(span)}.`));
    }
    if (!heap.isGroup(span)) return [...parts, ...this.raw(span)];
    const words = heap.words(span);
    const marked =
      address === first ? null : words.find((word) => word.first <= address && address <= word.last);
    return [...parts, this.fields(words, kind, span, marked), ...this.who(span)];
  }

  /** What stood where a span begins in the state before. */
  former(span) {
    const was = this.before.spanOf(this.heap.first[span]);
    if (was < 0) return "not in the page";
    const begins = this.before.first[was] === this.heap.first[span];
    return `${begins ? "" : "part of "}${nameOf(this.before, was)}`;
  }

  fields(words, kind, span, marked) {
    const lines = words.map((word) => this.field(word, kind, span, word === marked));
    return element("table", {}, element("tbody", {}, ...lines));
  }

  /** One line: name, value with unit, what it was before, where it leads, and the text of the table. */
  field(word, kind, span, marked) {
    const { heap, before } = this;
    const value = heap.value(word);
    const bits = heap.state.reals;
    const was = before && span !== null ? former(heap, before, span, word) : undefined;
    const changed = was !== undefined && !Object.is(was, value);
    const unit = word.field.unit ? [element("small", {}, ` ${word.field.unit}`)] : [];
    const parts =
      value === undefined ? [] : [element("span", { className: "number" }, exact(value, bits), ...unit)];
    if (changed) parts.push(element("small", { className: "was" }, `was ${exact(was, bits)}`));
    const line = element(
      "tr",
      { title: title(heap, word) },
      element("th", { scope: "row" }, word.name),
      element("td", {}, element("div", {}, ...parts, ...this.says(word, kind))),
    );
    line.classList.toggle("word", marked);
    line.classList.toggle("changed", changed);
    return line;
  }

  /** What a value means: where it leads as a link, a code in words; and the text of its field. */
  says(word, kind) {
    const found = meaning(this.heap, word, kind);
    const shown = found.to ? link(found.to, found.text, this.state) : found.text;
    const text = found.text === word.field.text ? [] : [element("span", {}, shown)];
    if (!found.sound) text[0].className = "fault";
    return word.field.role === "head" ? text : [...text, element("small", {}, word.field.text)];
  }

  /** Words of what is no group, as integers. */
  raw(span) {
    const { heap } = this;
    const first = heap.first[span];
    const many = heap.kind(span) === heap.table.unused ? 0 : Math.min(heap.size(span), RAW);
    const words = Array.from({ length: many }, (_, k) => String(heap.ints[first - 1 + k]));
    const next = heap.kind(span) === heap.table.junk ? Number(heap.ints[first - 1 + heap.table.junkNext]) : 0;
    const leads = next
      ? [element("p", {}, "next of its size: ", link(next, `junk@${next}`, this.state))]
      : [];
    return [...leads, ...(many ? [element("pre", {}, words.join(" "))] : []), ...this.who(span)];
  }

  who(span) {
    const found = whoPoints(this.heap, span);
    const lines = found.slice(0, SHOWN).map((one) => {
      const place =
        one.span < 0
          ? link(one.name, "common block", this.state)
          : link(one.first, called(this.heap, one.span), this.state);
      return element("tr", {}, element("th", { scope: "row" }, one.name), element("td", {}, place));
    });
    const left = found.length > SHOWN ? ` The first ${SHOWN} of them:` : "";
    return [
      element("h3", {}, `Who points here: ${counted(found.length, "word")}.${left}`),
      element("table", {}, element("tbody", {}, ...lines)),
    ];
  }

  /** The variables of the common block, `name` marked; of the numbers of materials those that are not 0. */
  commons(name) {
    const meant = (word) => word.name === name || word.field.name === name;
    const all = this.heap.variables();
    if (name !== COMMON && !all.some(meant)) return this.nothing(0);
    const words = all.filter(
      (word) => word.field.count === 1 || word.name === name || this.heap.value(word) !== 0,
    );
    return [
      element("h2", {}, "the common block"),
      element("p", { className: "muted" }, "of the arrays by material, only elements that are not 0"),
      this.fields(words, COMMON, null, words.find(meant)),
    ];
  }

  // ---- what was found

  /** A list of groups, with the values of a field if it names one. */
  find(list) {
    Object.assign(this, { list, column: 0, falling: false });
    this.showList();
  }

  close() {
    this.list = null;
    this.found.replaceChildren();
    this.listed([]);
  }

  showList() {
    const { heap, list } = this;
    const all = rows(heap, list, this.column, this.falling);
    this.listed(list.where ? all.map(({ address }) => address) : []);
    const unit = list.words[0]?.field.unit;
    const shut = element(
      "button",
      { type: "button", ariaLabel: "close the list", onclick: () => this.close() },
      "×",
    );
    const lines = all.slice(0, SHOWN).map(({ address, values }) => {
      const numbers = values.map((value) =>
        element("td", { className: "number" }, value === undefined ? "" : exact(value, heap.state.reals)),
      );
      const place = link(address, called(heap, heap.spanOf(address)), this.state);
      return element("tr", {}, element("td", {}, place), ...numbers);
    });
    const head = ["group", ...list.words.map((word) => word.name)].map((text, k) => this.heading(text, k));
    const more = all.length > SHOWN ? `; the first ${SHOWN} in this order:` : "";
    const text = list.words.length && !list.where ? `${list.words[0].field.text}${unit ? ` (${unit})` : ""}: ` : "";
    this.found.replaceChildren(
      element("h2", {}, cell(list.kind), list.title, shut),
      element("p", { className: "muted" }, `${text}${counted(all.length, "group")}${more}`),
      element(
        "div",
        { className: "rows" },
        element(
          "table",
          {},
          element("thead", {}, element("tr", {}, ...head)),
          element("tbody", {}, ...lines),
        ),
      ),
    );
  }

  /** A column's heading, by which the list is put in order; twice for falling order. */
  heading(text, k) {
    const mine = this.column === k;
    const order = () => {
      Object.assign(this, { column: k, falling: mine && !this.falling });
      this.showList();
      this.found.querySelectorAll("thead button")[k].focus();
    };
    const sign = mine ? (this.falling ? " ▼" : " ▲") : "";
    const made = element(
      "th",
      { scope: "col" },
      element("button", { type: "button", onclick: order }, text + sign),
    );
    if (mine) made.ariaSort = this.falling ? "descending" : "ascending";
    return made;
  }

  // ---- the state as a whole

  faultsOf(address) {
    return this.heap.state.faults
      .filter(([, message]) => named(message).includes(address))
      .map((fault) => this.fault(fault));
  }

  /** A sentence of the checker, its groups as links. */
  fault([invariant, message]) {
    const parts = message.split(/\b([a-z]+@[0-9]+)/);
    const shown = parts.map((part, k) => (k % 2 ? link(part.split("@")[1], part, this.state) : part));
    return element("p", { className: "fault" }, `invariant ${invariant}: `, ...shown);
  }

  showAbout() {
    const { faults, faultsLeft, deck, deckLeft, shown, used } = this.heap.state;
    const many = faults.length + faultsLeft;
    const parts = [];
    if (shown < used) {
      parts.push(
        element(
          "p",
          { className: "fault" },
          `This page has room for the words 1 to ${shown}. Those from ` +
            `${shown + 1} to ${used} are left out, and with them all groups that stand there.`,
        ),
      );
    }
    if (!many) parts.push(element("p", { className: "muted" }, "The checker finds this state sound."));
    else {
      const left = faultsLeft ? [element("p", {}, `and ${faultsLeft} more`)] : [];
      parts.push(
        element(
          "details",
          {},
          element("summary", {}, `The checker finds ${counted(many, "violation")}`),
          ...faults.map((one) => this.fault(one)),
          ...left,
        ),
      );
    }
    if (deck.length) {
      const left = deckLeft ? `... ${counted(deckLeft, "line")} before these left out\n` : "";
      parts.push(
        element(
          "details",
          {},
          element("summary", {}, `The deck that led here: ${counted(deck.length + deckLeft, "line")}`),
          element("pre", {}, left + deck.join("\n")),
        ),
      );
    }
    const common = link(COMMON, "The common block", this.state);
    this.about.replaceChildren(...parts, element("p", {}, common));
  }
}

/** What a line of fields says while the mouse is on it: the field's text, its words as they are. */
function title(heap, word) {
  if (word.index !== undefined) return word.field.text;
  const raw = Array.from(heap.ints.slice(word.first - 1, word.last), String).join(" ");
  return `${word.field.text}\nword ${word.first}: ${raw}`;
}
