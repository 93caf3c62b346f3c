// Where things lie: outlines of blocks, points of corners, contacts and grid-points, zones, and domains as
// polygons. All of it follows from the words of one state; lengths are metres.
//
// A heap may be damaged. So every walk ends where it meets something twice or something of another kind; what
// could not be followed to its end is not `whole`. The time is in proportion to the groups that there are.

const [CORNER_CORNER, CORNER_EDGE] = [1, 2]; // codes of contacts; 3 is CORNER_EDGE with the blocks exchanged
const VIRTUAL = 4; // the code of a contact that only keeps the map connected
const KINDS = ["block", "corner", "contact", "domain", "gridpoint", "zone"]; // that have a place
const ARC_STEPS = 8; // chords in place of an arc, where a place is looked up

export class Shapes {
  constructor(heap) {
    this.heap = heap;
    this.rounding = heap.variable("DTOL");
    this.read = readers(heap);
    this.at = new Map(); // address -> shape
    heap.groups.corner.forEach((address) => this.at.set(address, this.corner(address)));
    const seen = new Set();
    heap.groups.block.forEach((address) => this.at.set(address, this.block(address, seen)));
    heap.groups.contact.forEach((address) => this.at.set(address, this.contact(address)));
    heap.groups.gridpoint.forEach((address) =>
      this.at.set(address, this.point("gridpoint", address, "KXG", "KYG")),
    );
    heap.groups.zone.forEach((address) => this.at.set(address, this.zone(address)));
    const passed = new Set();
    heap.groups.domain.forEach((address) => this.at.set(address, this.domain(address, passed)));
    this.lists = Object.fromEntries(
      KINDS.map((kind) => [kind, heap.groups[kind].map((address) => this.at.get(address))]),
    );
    this.bounds = bounds(this.of("corner"));
  }

  /** All shapes of a kind, in order of address. */
  of(kind) {
    return this.lists[kind];
  }

  point(kind, address, x, y) {
    return { kind, address, x: this.read[x](address), y: this.read[y](address) };
  }

  /** A corner: its place, the circle that rounds it, and where the arc begins, ends and has its middle. */
  corner(address) {
    const { read, rounding: d } = this;
    const { x: px, y: py } = this.point("corner", address, "KXP", "KYP");
    const sharp = { kind: "corner", address, px, py, x: px, y: py, r: 0, begin: [px, py], end: [px, py] };
    const r = read.KRAD(address);
    const cx = read.KXCP(address);
    const cy = read.KYCP(address);
    const [mx, my] = [cx - px, cy - py];
    const mm = mx * mx + my * my;
    if (!(r > 0 && d > 0 && mm > 0 && mm < Infinity)) return sharp;
    const along = (d * d) / mm; // with m from the corner to the centre: p + (d^2 m -/+ d r Jm) / m.m
    const across = (d * r) / mm;
    const begin = [px + along * mx + across * my, py + along * my - across * mx];
    const end = [px + along * mx - across * my, py + along * my + across * mx];
    const far = r / Math.sqrt(mm);
    return { ...sharp, x: cx - far * mx, y: cy - far * my, r, cx, cy, begin, end };
  }

  /** A block: its corners, clockwise, along the reverse list from KP on; soft: the kind of its extension. */
  block(address, seen) {
    const start = this.read.KP(address);
    const corners = [];
    let here = start;
    while (this.heap.holds("corner", here) && !seen.has(here)) {
      seen.add(here);
      corners.unshift(this.at.get(here));
      here = this.read.KR(here);
    }
    const whole = corners.length > 2 && here === start;
    const extension = this.heap.spanOf(this.read.KBEX(address));
    const soft = this.heap.isGroup(extension) ? this.heap.kind(extension) : "block";
    const range = box(corners.map((one) => [one.px, one.py]));
    return { kind: "block", address, corners, whole, soft, extension: this.read.KBEX(address), box: range };
  }

  /** A contact: its place; a virtual one has none of its own, and lies between the corners that it links. */
  contact(address) {
    const shape = this.point("contact", address, "KXC", "KYC");
    if (this.read.KCCOD(address) !== VIRTUAL) return { ...shape, virtual: false, force: this.force(address) };
    const ends = [this.read.KCP1(address), this.read.KCP2(address)].map(
      (corner) => this.at.get(corner) ?? shape,
    );
    const [x, y] = [(ends[0].x + ends[1].x) / 2, (ends[0].y + ends[1].y) / 2];
    return { ...shape, x, y, virtual: true, ends: ends.map((one) => [one.x, one.y]) };
  }

  /** The force of a contact on its block KB2: along the normal, less along the tangent. */
  force(address) {
    const { read } = this;
    const [nx, ny] = this.normal(address);
    const [fn, fs] = [read.KCFN(address), read.KCFS(address)];
    return [fn * nx + fs * ny, fn * ny - fs * nx];
  }

  /** The normal of a contact, from KB1 to KB2: between two circles, or across an edge; NaN if there is none. */
  normal(address) {
    const { read } = this;
    const [one, two] = [read.KCP1(address), read.KCP2(address)].map((corner) => this.at.get(corner));
    const code = read.KCCOD(address);
    let [dx, dy] = [NaN, NaN];
    if (code === CORNER_CORNER && one && two) {
      [dx, dy] = ["KXCP", "KYCP"].map((name) => read[name](two.address) - read[name](one.address));
    } else {
      const end = code === CORNER_EDGE ? two : one;
      const begin = end && this.at.get(read.KR(end.address));
      const side = code === CORNER_EDGE ? -1 : 1; // the outward normal of the edge, turned to point to KB2
      if (begin) [dx, dy] = [-side * (end.py - begin.py), side * (end.px - begin.px)];
    }
    const length = Math.hypot(dx, dy);
    return [dx / length, dy / length];
  }

  zone(address) {
    const kind = this.heap.table.kinds.zone;
    const triple = kind.fields.find((field) => field.role === "triple");
    const points = Array.from({ length: triple.count }, (_, element) => {
      const word = this.heap.word("zone", { field: triple, element }, address);
      const point = this.at.get(Number(this.heap.value(word)));
      return [point?.x ?? NaN, point?.y ?? NaN];
    });
    return { kind: "zone", address, points, box: box(points) };
  }

  /** A domain: points along its loop. They may lie inside blocks beside it, which are drawn over it. */
  domain(address, passed) {
    const points = [];
    let step = this.beginning(address);
    const start = step;
    const key = ({ item, block }) =>
      2 * item + Number(this.read.KB1(item) === block && this.heap.holds("contact", item));
    while (step && !passed.has(key(step))) {
      passed.add(key(step));
      const following = this.following(step);
      if (following) points.push(...this.stand(following.item, step.block));
      step = following;
    }
    const whole = Boolean(step && start && key(step) === key(start));
    const outer = address === this.heap.variable("IODPNT");
    return { kind: "domain", address, points, whole, outer, box: box(points) };
  }

  /** Where the loop of a domain begins: a contact and the block after it, or a corner of the only block. */
  beginning(domain) {
    const { heap, read } = this;
    const contact = read.KDLOOP(domain);
    if (heap.holds("contact", contact)) {
      return { item: contact, block: read.KD1(contact) === domain ? read.KB2(contact) : read.KB1(contact) };
    }
    const block = heap.variable("IBPNT");
    const alone = contact === 0 && heap.holds("block", block) && heap.holds("corner", read.KP(block));
    return alone ? { item: read.KP(block), block } : null;
  }

  /** The next step along a loop: the next item on the block, and the block from there; null if it breaks. */
  following({ item, block }) {
    const { heap, read } = this;
    let to = 0;
    if (heap.holds("corner", item)) to = read.KL(item);
    else if (read.KB1(item) === block) to = read.KL1(item);
    else if (read.KB2(item) === block) to = read.KL2(item);
    if (heap.holds("corner", to)) return { item: to, block };
    if (!heap.holds("contact", to)) return null;
    return { item: to, block: read.KB1(to) === block ? read.KB2(to) : read.KB1(to) };
  }

  /** Points of a loop at an item, come to along a block. A corner stands for the end of its arc. */
  stand(item, block) {
    const shape = this.at.get(item);
    if (shape.kind === "corner") return [shape.end];
    if (!shape.virtual) return [[shape.x, shape.y]];
    return this.read.KB1(item) === block ? shape.ends : [...shape.ends].reverse();
  }

  /** Shapes that stand for a group: its own, or those of the groups that it belongs to or watches. */
  standFor(span) {
    const { heap } = this;
    if (!heap.isGroup(span)) return [];
    const own = this.at.get(heap.first[span]);
    if (own) return [own];
    const words = heap.words(span);
    for (const role of ["member", "watched", "host"]) {
      const targets = words
        .filter((word) => word.field.role === role)
        .map((word) => Number(heap.value(word)));
      const found = targets.filter((address) => this.at.has(address)).map((address) => this.at.get(address));
      if (found.length) return found;
    }
    const owner = this.at.get(heap.owner[span]);
    return owner ? [owner] : [];
  }

  /** What lies at a place, small things first: contacts, corners, grid-points within `reach`, then areas. */
  lyingAt(x, y, reach) {
    const far = (one) => Math.hypot(one.x - x, one.y - y);
    const near = ["contact", "corner", "gridpoint"].flatMap((kind) =>
      this.of(kind)
        .filter((one) => Math.abs(one.x - x) <= reach && far(one) <= reach)
        .sort((a, b) => far(a) - far(b)),
    );
    const blocks = this.of("block").filter((one) => inBox(one.box, x, y) && inside(outline(one), x, y));
    const zones = this.of("zone").filter((one) => inBox(one.box, x, y) && inside(one.points, x, y));
    const around = (one) => one.outer !== (inBox(one.box, x, y) && inside(one.points, x, y));
    const domains = blocks.length ? [] : this.of("domain").filter((one) => one.points.length && around(one));
    return [...near, ...blocks, ...zones, ...domains];
  }
}

/** Readers of all fields of the kinds that have a place, by name. */
function readers(heap) {
  return Object.fromEntries(
    KINDS.flatMap((kind) =>
      heap.table.kinds[kind].fields.map((field) => [field.name, heap.reader(kind, field.name)]),
    ),
  );
}

/** Where a shape is: a point itself, an area in the middle of its box. */
export function centre({ box: range, x, y }) {
  return range ? [(range[0] + range[2]) / 2, (range[1] + range[3]) / 2] : [x, y];
}

/** The outline of a block as a polygon, its arcs by chords. */
export function outline(block) {
  return block.corners.flatMap((one) => {
    if (!(one.r > 0)) return [[one.px, one.py]];
    const [first, turn] = arc(one);
    return Array.from({ length: ARC_STEPS + 1 }, (_, k) => {
      const angle = first + (turn * k) / ARC_STEPS;
      return [one.cx + one.r * Math.cos(angle), one.cy + one.r * Math.sin(angle)];
    });
  });
}

/** Where the arc of a corner begins, as an angle, and how far it turns. */
export function arc(corner) {
  const angle = ([x, y]) => Math.atan2(y - corner.cy, x - corner.cx);
  const first = angle(corner.begin);
  const turn = angle(corner.end) - first;
  return [first, turn - 2 * Math.PI * Math.round(turn / (2 * Math.PI))];
}

/** The range of x and y of points, [x1, y1, x2, y2]; what is no number does not count. */
function box(points) {
  const range = [Infinity, Infinity, -Infinity, -Infinity];
  for (const [x, y] of points) {
    if (!Number.isFinite(x + y)) continue;
    range[0] = Math.min(range[0], x);
    range[1] = Math.min(range[1], y);
    range[2] = Math.max(range[2], x);
    range[3] = Math.max(range[3], y);
  }
  return range;
}

function inBox([x1, y1, x2, y2], x, y) {
  return x1 <= x && x <= x2 && y1 <= y && y <= y2;
}

/** True if a place is inside a polygon: a line from it to the left crosses an odd number of edges. */
function inside(points, x, y) {
  let odd = false;
  points.forEach(([x1, y1], k) => {
    const [x2, y2] = points[(k + 1) % points.length];
    if (y1 > y !== y2 > y && x < x1 + ((y - y1) / (y2 - y1)) * (x2 - x1)) odd = !odd;
  });
  return odd;
}

/** Range of x and y of all corners, [x1, y1, x2, y2]; what lies far from the bulk of them does not count. */
function bounds(corners) {
  const [x1, x2] = bulk(corners.map((one) => one.px));
  const [y1, y2] = bulk(corners.map((one) => one.py));
  return [x1, y1, x2, y2];
}

/** The range of numbers, but not further from their middle eight tenths than twice the width of these. */
function bulk(numbers) {
  const sorted = Float64Array.from(numbers.filter(Number.isFinite)).sort();
  if (!sorted.length) return [0, 1];
  const last = sorted.length - 1;
  const [low, high] = [sorted[Math.floor(0.1 * last)], sorted[Math.ceil(0.9 * last)]];
  const room = 2 * (high - low) || Infinity;
  return [Math.max(sorted[0], low - room), Math.min(sorted[last], high + room)];
}
