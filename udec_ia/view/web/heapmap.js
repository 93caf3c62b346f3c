// The words of IA() in rows, every group a cell in the colour of its kind. The canvas has the size of what is
// seen; a box as high as all rows scrolls behind it, so that only the rows in sight are drawn.

import { changed } from "./changes.js";
import { colours, framed, hatching, inkOn, mixed, prepared, ringed, warned } from "./drawing.js";
import { exact } from "./numbers.js";
import { Rows, WIDTHS, fitting } from "./rows.js";
import { nameOf } from "./words.js";

const LEFT = 58; // pixels for the addresses of the rows
const FIELDS = 26; // pixels that a word must have, to be shown with its field

export class HeapMap {
  /** box: the element that scrolls; canvas and all: in it; on.select, on.hover: called with an address. */
  constructor(box, canvas, all, hint, on) {
    Object.assign(this, { box, canvas, all, hint, on, heap: null, before: null, faults: new Set() });
    Object.assign(this, { chosen: -1, word: 0, near: [], to: [], from: [], pointed: -1, fitted: true });
    this.draw = framed(() => this.drawNow());
    new ResizeObserver(() => (this.fitted ? this.fit() : this.arrange())).observe(box);
    box.addEventListener("scroll", () => this.draw());
    canvas.addEventListener("click", (event) => this.click(event));
    canvas.addEventListener("pointermove", (event) => this.over(event));
    canvas.addEventListener("pointerleave", () => this.over(null));
    canvas.addEventListener("keydown", (event) => this.key(event));
  }

  /** Show a state; the one before it, or null; numbers of the spans that the checker complains of. */
  show(heap, before, faults) {
    Object.assign(this, { heap, before, faults, pointed: -1 });
    this.perRow ??= fitting(heap, LEFT, this.width(), this.box.clientHeight);
    this.arrange();
  }

  /** Ring a span and one of its words, what belongs to it, and mark what it leads to and what leads to it. */
  mark(chosen, word, near, to, from) {
    Object.assign(this, { chosen, word, near, to, from });
    if (chosen >= 0) this.reveal(word || this.heap.first[chosen]);
    this.draw();
  }

  /** Ring a span for as long as the mouse points at its name elsewhere; -1 for none. */
  point(span) {
    this.pointed = span;
    this.draw();
  }

  // ---- rows

  width() {
    return Math.max(this.box.clientWidth - LEFT - 6, 50);
  }

  closer() {
    this.zoom(-1);
  }

  further() {
    this.zoom(1);
  }

  /** More or fewer words in a row: `step` places further in the list of widths. */
  zoom(step) {
    const k = WIDTHS.indexOf(this.perRow) + step;
    this.perRow = WIDTHS[Math.min(Math.max(k, 0), WIDTHS.length - 1)];
    this.fitted = false;
    this.arrange();
    if (this.chosen >= 0) this.reveal(this.word || this.heap.first[this.chosen]);
  }

  /** As many words in a row as let all of them be seen, also when the window changes, until it is zoomed. */
  fit() {
    this.fitted = true;
    if (!this.heap || !this.box.clientWidth) return;
    this.perRow = fitting(this.heap, LEFT, this.width(), this.box.clientHeight);
    this.arrange();
  }

  arrange() {
    if (!this.heap || !this.box.clientWidth) return;
    this.rows = new Rows(this.heap, this.perRow, LEFT, this.width());
    this.canvas.style.height = `${this.box.clientHeight}px`;
    this.all.style.height = `${this.rows.count * this.rows.high + 4}px`;
    this.draw();
  }

  /** Scroll until a word is seen. */
  reveal(address) {
    if (!this.rows) return;
    const y = Math.min(this.rows.row(address), this.rows.count - 1) * this.rows.high;
    const { scrollTop: top, clientHeight: height } = this.box;
    if (y < top || y + this.rows.high > top + height) this.box.scrollTop = y - height / 2;
  }

  // ---- events

  addressAt(event) {
    const address = this.rows.addressAt(event.offsetX, event.offsetY + this.box.scrollTop);
    return address <= this.heap.first[this.heap.first.length - 1] - 1 ? address : 0;
  }

  click(event) {
    const address = this.addressAt(event);
    if (address) this.on.select(address);
  }

  over(event) {
    const address = event ? this.addressAt(event) : 0;
    this.on.hover(address);
    this.hint.hidden = !address;
    if (!address) return;
    this.hint.style.left = `${Math.min(event.offsetX + 12, this.width() + LEFT - this.hint.offsetWidth)}px`;
    this.hint.style.top = `${Math.max(event.offsetY - 28, 0)}px`;
  }

  /** Arrows go to the groups beside, and a row up or down; Home and End to the first and the last. */
  key(event) {
    if (event.altKey || event.ctrlKey || event.metaKey) return;
    const { heap, chosen, rows } = this;
    const last = heap.first.length - 2;
    const at = chosen < 0 ? 1 : this.word || heap.first[chosen];
    const ways = {
      ArrowLeft: () => heap.first[Math.max(chosen - 1, 0)],
      ArrowRight: () => heap.first[Math.min(chosen + 1, last)],
      ArrowUp: () => (at > rows.perRow ? at - rows.perRow : at),
      ArrowDown: () => Math.min(at + rows.perRow, heap.first[last + 1] - 1),
      Home: () => 1,
      End: () => heap.first[last],
    };
    if (event.key === "+" || event.key === "=") this.closer();
    else if (event.key === "-") this.further();
    else if (event.key === "0") this.fit();
    else if (ways[event.key]) this.on.select(ways[event.key]());
    else return;
    event.preventDefault();
  }

  // ---- drawing

  drawNow() {
    if (!this.rows || !this.canvas.clientWidth) return;
    const { pen, height } = prepared(this.canvas);
    const { rows, heap } = this;
    const colour = colours(heap.table);
    const top = this.box.scrollTop;
    this.fromRow = Math.floor(top / rows.high);
    this.toRow = Math.min(Math.floor((top + height) / rows.high), rows.count - 1);
    pen.translate(0, -top);
    this.drawAddresses(pen, colour);
    const begin = heap.spanOf(this.fromRow * rows.perRow + 1);
    const end = (this.toRow + 1) * rows.perRow;
    const hatches = this.hatches(pen, colour);
    for (let span = begin; span >= 0 && span < heap.kinds.length && heap.first[span] <= end; span++) {
      this.drawSpan(pen, colour, hatches, span);
    }
    if (this.before) this.drawChanges(pen, colour, end);
    this.drawMarks(pen, colour);
  }

  hatches(pen, colour) {
    const { unused, nothing } = this.heap.table;
    return { [unused]: hatching(pen, colour.muted), [nothing]: hatching(pen, colour.fault) };
  }

  pieces(span) {
    const { heap, rows } = this;
    return rows.pieces(heap.first[span], heap.first[span + 1] - 1, this.fromRow, this.toRow);
  }

  /** Addresses of the rows, as many as can be read. */
  drawAddresses(pen, colour) {
    const { rows } = this;
    const every = Math.ceil(13 / rows.high);
    pen.fillStyle = colour.muted;
    pen.font = "11px ui-monospace, monospace";
    pen.textAlign = "right";
    pen.textBaseline = "middle";
    for (let row = Math.ceil(this.fromRow / every) * every; row <= this.toRow; row += every) {
      pen.fillText(row * rows.perRow + 1, LEFT - 8, (row + 0.5) * rows.high);
    }
  }

  /** One span: a group in its colour, junk dimmed, the rest hatched; with its name or its fields. */
  drawSpan(pen, colour, hatches, span) {
    const { heap, rows } = this;
    const kind = heap.kind(span);
    const fill = hatches[kind] ?? colour[kind];
    const pieces = this.pieces(span);
    const gap = rows.wide * heap.size(span) > 4 ? 1 : 0;
    pen.fillStyle = fill;
    pieces.forEach(({ x, y, width }, k) => {
      const end = k === pieces.length - 1 ? gap : 0;
      pen.fillRect(x, y, width - end, rows.high - (rows.high > 6 ? 2 : 1));
    });
    if (heap.isGroup(span) && rows.wide >= FIELDS) this.drawFields(pen, fill, span);
    else if (!hatches[kind] && rows.high >= 10) this.drawName(pen, fill, span, pieces);
  }

  drawName(pen, fill, span, pieces) {
    const { rows } = this;
    const { x, y, width } =
      pieces.length > 1 && pieces[1].width > pieces[0].width ? pieces[1] : (pieces[0] ?? {});
    if (!width) return;
    const junk = this.heap.kind(span) === this.heap.table.junk;
    pen.font = `${rows.high >= 16 ? 11 : 9}px system-ui, sans-serif`;
    const fits = (text) => pen.measureText(text).width < width - 7;
    const name = [nameOf(this.heap, span), this.heap.kind(span)].find(fits);
    if (!name) return;
    pen.fillStyle = junk ? mixed(fill, inkOn(fill), 0.45) : inkOn(fill);
    pen.textAlign = "left";
    pen.fillText(name, x + 4, y + (rows.high - 2) / 2);
  }

  /** The fields of a group with their values, word by word. */
  drawFields(pen, fill, span) {
    const { heap, rows } = this;
    const ink = inkOn(fill);
    pen.textAlign = "left";
    for (const word of heap.words(span)) {
      for (const { x, y, width } of rows.pieces(word.first, word.last, this.fromRow, this.toRow)) {
        pen.fillStyle = mixed(fill, ink, 0.6);
        pen.fillRect(x + width - 1, y, 1, rows.high - 2);
        pen.fillStyle = ink;
        pen.save();
        pen.beginPath();
        pen.rect(x, y, width - 3, rows.high);
        pen.clip();
        const head = word.field.role === "head";
        pen.font = "bold 9px system-ui, sans-serif";
        pen.fillText(head ? nameOf(heap, span) : word.name, x + 3, y + 9);
        pen.font = "10px ui-monospace, monospace";
        const value = heap.value(word);
        pen.fillText(word.field.type === "int" ? exact(value) : Number(value?.toPrecision(4)), x + 3, y + 23);
        pen.restore();
      }
    }
  }

  /** A bar below the words that have changed since the state before. */
  drawChanges(pen, colour, end) {
    const { heap, rows, before } = this;
    const bar = Math.max(1.5, rows.high / 7);
    pen.fillStyle = colour.ink;
    pen.globalAlpha = 0.65;
    const last = Math.min(end, heap.state.shown);
    for (let address = this.fromRow * rows.perRow + 1; address <= last; address++) {
      if (!changed(heap, before, address, address)) continue;
      const [{ x, y, width }] = rows.pieces(address, address);
      pen.fillRect(x, y + rows.high - bar - 1, width, bar);
    }
    pen.globalAlpha = 1;
  }

  /** The span that is selected and its word, what belongs to it, and the ends of its pointers. */
  drawMarks(pen, colour) {
    const { rows } = this;
    const ring = (pieces, width) => {
      pen.beginPath();
      for (const { x, y, width: wide } of pieces) pen.rect(x - 0.5, y - 0.5, wide, rows.high - 1);
      ringed(pen, colour, width);
    };
    for (const span of this.near) ring(this.pieces(span), 1);
    for (const [spans, filled] of [
      [this.from, false],
      [this.to, true],
    ]) {
      for (const span of spans) this.drawEnd(pen, colour, span, filled);
    }
    if (this.chosen >= 0) ring(this.pieces(this.chosen), 2.5);
    if (this.word) ring(rows.pieces(this.word, this.word, this.fromRow, this.toRow), 2);
    if (this.pointed >= 0) ring(this.pieces(this.pointed), 2);
    const size = Math.min(8, 0.55 * rows.high);
    for (const span of this.faults) {
      for (const { x, y, width } of this.pieces(span).slice(0, 1)) {
        warned(pen, colour, x + width - Math.min(size + 2, width / 2), y + rows.high / 2, size);
      }
    }
  }

  /** A dot where a pointer of the selected group leads; a ring where one stands that leads to it. */
  drawEnd(pen, colour, span, filled) {
    for (const { x, y, width } of this.pieces(span).slice(0, 1)) {
      const size = Math.min(this.rows.high / 2, filled ? 3 : 5);
      pen.beginPath();
      pen.arc(x + Math.min(8, width / 2), y + (this.rows.high - 1) / 2, size, 0, 2 * Math.PI);
      ringed(pen, colour, 1.5);
      if (filled) {
        pen.fillStyle = colour.ink;
        pen.fill();
      }
    }
  }
}
