// How the words of IA() stand in rows: which word is where, in pixels. A row holds a round number of words,
// and is the higher the fewer there are. Of the words that are not used only the first rows are there.

// Words in a row.
export const WIDTHS = [6, 8, 10, 20, 30, 40, 50, 60, 80, 100, 150, 200, 300, 400, 500, 1000, 2000];
const HEIGHTS = [
  [26, 36],
  [14, 22],
  [6, 16],
  [3, 10],
  [1, 8],
  [0, 6],
]; // from this width of a word on: of a row
const UNUSED = 0.15; // rows of unused words, as a share of the others

export class Rows {
  /** heap: a state; perRow: words in a row; left, width: pixels where the words begin, and that they have. */
  constructor(heap, perRow, left, width) {
    Object.assign(this, { perRow, left, wide: width / perRow });
    this.high = HEIGHTS.find(([from]) => this.wide >= from)[1];
    const used = Math.max(Math.ceil(heap.state.shown / perRow), 1);
    const all = Math.ceil((heap.first[heap.first.length - 1] - 1) / perRow);
    this.count = Math.min(all, used + Math.max(2, Math.ceil(UNUSED * used)));
    this.last = this.count * perRow;
  }

  /** The stretches of an address range, one for each row: { x, y, width }, from the row `from` on. */
  pieces(first, last, from = 0, to = this.count - 1) {
    const found = [];
    const end = Math.min(this.row(last), to);
    for (let row = Math.max(this.row(first), from); row <= end; row++) {
      const begin = Math.max(first - 1, row * this.perRow) - row * this.perRow;
      const stop = Math.min(last, (row + 1) * this.perRow) - row * this.perRow;
      found.push({ x: this.left + begin * this.wide, y: row * this.high, width: (stop - begin) * this.wide });
    }
    return found;
  }

  row(address) {
    return Math.floor((address - 1) / this.perRow);
  }

  /** The address at a place, or 0. */
  addressAt(x, y) {
    const column = Math.floor((x - this.left) / this.wide);
    const row = Math.floor(y / this.high);
    return column >= 0 && column < this.perRow && row >= 0 && row < this.count
      ? row * this.perRow + column + 1
      : 0;
  }
}

/** Words in a row, so that all that is used stands within a height; else as many as is still readable. */
export function fitting(heap, left, width, height) {
  const readable = WIDTHS.filter((perRow) => width / perRow >= 0.7);
  const fits = readable.find((perRow) => {
    const rows = new Rows(heap, perRow, left, width);
    return rows.count * rows.high <= height;
  });
  return fits ?? readable[readable.length - 1];
}
