// Draws shapes with a pen: domains, blocks over them, then what stands in and on these, and rings round what
// is selected. There may be many thousands, of which only those in sight are drawn.

import { inkOn, mixed, ringed, warned } from "./drawing.js";
import { arc, centre } from "./shapes.js";

const POINTS = 26; // pixels that blocks must measure before their points are drawn
const NAMES = 44; // and before they are named
const PIECE = 200; // blocks in one path
const LONGEST = 400; // pixels of a block that forces are drawn for

/** How large blocks are, in pixels, as a whole. */
export function blockSize(shapes, eye) {
  const [x1, y1, x2, y2] = shapes.bounds;
  return eye.scale * Math.sqrt(((x2 - x1) * (y2 - y1)) / (shapes.of("block").length || 1));
}

/** True if blocks are large enough for their corners and contacts to be drawn, and clicked on. */
export function showsPoints(shapes, eye) {
  return blockSize(shapes, eye) > POINTS;
}

export class Painter {
  /** pen: of a canvas; colour: of the style sheet, by name; shapes: all there are; eye: what is seen.
   * scale: colours areas by a field, or null. */
  constructor(pen, colour, shapes, eye, scale = null) {
    Object.assign(this, { pen, colour, shapes, eye, scale, large: showsPoints(shapes, eye) });
  }

  /** Draw all. chosen: shapes to be filled; rings: shapes with the width of their rings; faults: marked.
   * forces: draw those of contacts. */
  draw(chosen, rings, faults, forces = false) {
    this.drawDomains(chosen);
    this.drawBlocks(chosen);
    if (this.large || this.scale?.isFor("zone")) this.drawZones(chosen);
    this.drawRings(rings);
    if (this.large) this.drawPoints();
    this.drawLinks();
    if (forces) this.drawForces();
    if (blockSize(this.shapes, this.eye) > NAMES) this.drawNames();
    this.drawFaults(faults);
  }

  /** The domains between blocks, if these are large; the outer one only while it is selected. */
  drawDomains(chosen) {
    const { pen, colour, eye } = this;
    for (const domain of this.shapes.of("domain")) {
      const strong = chosen.includes(domain);
      const scaled = !domain.outer && this.scaled(domain);
      if (!strong && (domain.outer || !(this.large || scaled) || !eye.sees(domain.box))) continue;
      pen.beginPath();
      if (domain.outer) pen.rect(0, 0, eye.width, eye.height);
      this.polygon(domain.points);
      pen.fillStyle = scaled || mixed(colour.domain, colour.paper, strong ? 0.75 : 0.35);
      pen.fill("evenodd");
    }
  }

  /** Blocks in the colour of their type, many of one colour as one path: faster than each, or all, as one. */
  drawBlocks(chosen) {
    const { pen, colour, eye } = this;
    const paths = new Map();
    for (const block of this.shapes.of("block")) {
      if (!eye.sees(block.box)) continue;
      const fill =
        this.scaled(block) ?? mixed(colour[block.soft], colour.paper, chosen.includes(block) ? 0.6 : 0.28);
      const key = `${fill} ${block.whole}`;
      if (!paths.has(key)) paths.set(key, { fill, whole: block.whole, blocks: [] });
      paths.get(key).blocks.push(block);
    }
    pen.strokeStyle = colour.ink;
    pen.lineWidth = this.large ? 1 : 0.4;
    for (const { fill, whole, blocks } of paths.values()) {
      pen.fillStyle = fill;
      pen.setLineDash(whole ? [] : [4, 4]);
      for (let k = 0; k < blocks.length; k += PIECE) {
        pen.beginPath();
        blocks.slice(k, k + PIECE).forEach((block) => this.outline(block));
        pen.fill();
        pen.stroke();
      }
    }
    pen.setLineDash([]);
  }

  /** Zones of fully-deformable blocks. */
  drawZones(chosen) {
    const { pen, colour, eye } = this;
    pen.strokeStyle = colour.zone;
    pen.lineWidth = 1.5;
    for (const zone of this.shapes.of("zone")) {
      if (!eye.sees(zone.box)) continue;
      pen.beginPath();
      this.polygon(zone.points);
      const scaled = this.scaled(zone);
      pen.fillStyle = scaled ?? mixed(colour.zone, colour.paper, 0.6);
      if (scaled || chosen.includes(zone)) pen.fill();
      pen.stroke();
    }
  }

  /** Corners, grid-points and contacts that have a place. */
  drawPoints() {
    const { pen, colour, eye } = this;
    for (const [kind, size] of Object.entries({ gridpoint: 2.5, corner: 2.5, contact: 4 })) {
      pen.fillStyle = colour[kind];
      pen.strokeStyle = colour.ink;
      pen.lineWidth = 0.7;
      pen.beginPath();
      for (const { x, y, virtual } of this.shapes.of(kind)) {
        if (!virtual && eye.sees([x, y, x, y])) dot(pen, kind, ...eye.pixel(x, y), size);
      }
      pen.fill();
      pen.stroke();
    }
  }

  /** Virtual contacts, as the links that they are. */
  drawLinks() {
    const { pen, colour } = this;
    pen.strokeStyle = colour.contact;
    pen.setLineDash([5, 3]);
    pen.lineWidth = 1.5;
    pen.beginPath();
    for (const { virtual, ends } of this.shapes.of("contact")) {
      if (virtual) this.polygon(ends);
    }
    pen.stroke();
    pen.setLineDash([]);
  }

  /** The forces of contacts as lines along them; the longest is half as long as blocks are wide. */
  drawForces() {
    const { pen, colour, eye, shapes } = this;
    const contacts = shapes.of("contact").filter(({ force }) => force && Number.isFinite(force[0] + force[1]));
    const greatest = contacts.reduce((most, { force }) => Math.max(most, Math.hypot(...force)), 0);
    const pixels = Math.min(blockSize(shapes, eye), LONGEST) / 4 / greatest; // to each side, for a unit of force
    for (const [style, width] of [
      [colour.paper, 3.5],
      [colour.ink, 1.5],
    ]) {
      pen.strokeStyle = style;
      pen.lineWidth = width;
      pen.lineCap = "round";
      pen.beginPath();
      for (const { x, y, force } of greatest > 0 ? contacts : []) {
        const [px, py] = eye.pixel(x, y);
        const [dx, dy] = [force[0] * pixels, -force[1] * pixels];
        if (!eye.sees([x, y, x, y]) || Math.hypot(dx, dy) < 0.5) continue;
        pen.moveTo(px - dx, py - dy);
        pen.lineTo(px + dx, py + dy);
      }
      pen.stroke();
    }
    pen.lineCap = "butt";
  }

  /** The colour of an area by the field that areas of its kind are coloured by, if it has a value. */
  scaled(shape) {
    return this.scale?.isFor(shape.kind) ? this.scale.colour(shape) : undefined;
  }

  drawRings(rings) {
    for (const [shapes, width] of rings) {
      for (const shape of shapes) {
        this.pen.beginPath();
        this.trace(shape);
        ringed(this.pen, this.colour, width);
      }
    }
  }

  /** The addresses of blocks that are large enough. */
  drawNames() {
    const { pen, colour, eye } = this;
    pen.font = "11px system-ui, sans-serif";
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    for (const block of this.shapes.of("block")) {
      const wide = (block.box[2] - block.box[0]) * eye.scale;
      if (!(wide > NAMES && eye.sees(block.box))) continue;
      const scaled = this.scaled(block);
      pen.fillStyle = scaled ? inkOn(scaled) : colour.ink;
      pen.fillText(block.address, ...eye.pixel(...centre(block)));
    }
  }

  /** What the checker complains of: points where they are, areas above their middle, where names stand. */
  drawFaults(faults) {
    for (const shape of faults) {
      const [x, y] = this.eye.pixel(...centre(shape));
      warned(this.pen, this.colour, x, shape.box ? y - 14 : y, 8);
    }
  }

  /** The path of any shape; a point is a small circle. */
  trace(shape) {
    if (shape.kind === "block") this.outline(shape);
    else if (shape.points) this.polygon(shape.points);
    else if (shape.virtual) this.polygon(shape.ends);
    else dot(this.pen, shape.kind, ...this.eye.pixel(shape.x, shape.y), 6);
  }

  polygon(points) {
    points.forEach(([x, y], k) => {
      if (k) this.pen.lineTo(...this.eye.pixel(x, y));
      else this.pen.moveTo(...this.eye.pixel(x, y));
    });
    this.pen.closePath();
  }

  /** A block with its rounded corners; one pixel of rounding is not worth an arc. */
  outline(block) {
    const { pen, eye } = this;
    block.corners.forEach((one, k) => {
      const radius = one.r * eye.scale;
      const round = radius > 1 && Number.isFinite(radius);
      const [x, y] = round ? eye.pixel(...one.begin) : eye.pixel(one.px, one.py);
      if (k) pen.lineTo(x, y);
      else pen.moveTo(x, y);
      if (!round) return;
      const [first, turn] = arc(one);
      pen.arc(...eye.pixel(one.cx, one.cy), radius, -first, -first - turn, turn > 0);
    });
    if (block.corners.length) pen.closePath();
  }
}

/** A diamond for a contact, a circle for any other point. */
function dot(pen, kind, x, y, size) {
  pen.moveTo(x + size, y);
  if (kind === "contact") {
    for (const [dx, dy] of [
      [0, size],
      [-size, 0],
      [0, -size],
      [size, 0],
    ])
      pen.lineTo(x + dx, y + dy);
  } else {
    pen.arc(x, y, size, 0, 2 * Math.PI);
  }
}
