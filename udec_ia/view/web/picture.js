// The picture of the blocks: what is clicked on is selected, and what is selected is ringed. It is zoomed by
// the wheel, buttons and keys, and drawn aside with the mouse. Arrows lead to the next thing of the same
// kind.

import { colours, framed, prepared } from "./drawing.js";
import { Eye } from "./eye.js";
import { Painter, blockSize, showsPoints } from "./painter.js";
import { centre } from "./shapes.js";

const REACH = 7; // pixels within which a click means a point
const FACTOR = 1.25; // of one step of the zoom
const FOUND = 2000; // shapes of a list that are ringed
const STILL = 4; // pixels that the mouse may move in a click
const WAYS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

export class Picture {
  /** canvas, hint: elements; on.select, on.hover: called with an address, 0 for none. */
  constructor(canvas, hint, on) {
    Object.assign(this, { canvas, hint, on, shapes: null, chosen: [], near: [], pointed: [], faults: [] });
    Object.assign(this, { eye: new Eye(), fitted: true, held: null, found: [], scale: null, forces: false });
    this.draw = framed(() => this.drawNow());
    this.resized();
    new ResizeObserver(() => this.resized()).observe(canvas);
    canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    canvas.addEventListener("pointerdown", (event) => this.grasp(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", (event) => this.release(event));
    canvas.addEventListener("pointercancel", () => this.leave());
    canvas.addEventListener("pointerleave", () => this.leave());
    canvas.addEventListener("keydown", (event) => this.key(event));
  }

  /** Show a state; addresses that the checker complains of. The part of the plane that is seen stays. */
  show(shapes, faults) {
    const first = !this.shapes;
    this.shapes = shapes;
    this.faults = faults.map((address) => shapes.at.get(address)).filter(Boolean);
    this.pointed = [];
    if (first) this.fit();
    this.draw();
  }

  /** Ring shapes, and with a thinner line those that belong to them; come to them if none is seen. */
  mark(chosen, near) {
    Object.assign(this, { chosen, near });
    const places = chosen.map(centre).filter(([x, y]) => Number.isFinite(x + y));
    if (places.length && !places.some(([x, y]) => this.eye.sees([x, y, x, y]))) {
      [this.eye.x, this.eye.y] = places[0];
    }
    this.draw();
  }

  /** Ring shapes that were found, thinly. */
  list(shapes) {
    this.found = shapes.slice(0, FOUND);
    this.draw();
  }

  /** Colour areas by a scale, or by their types if it is null; draw forces or not. */
  paint(scale, forces) {
    Object.assign(this, { scale, forces });
    this.draw();
  }

  /** Ring shapes for as long as the mouse points at their names elsewhere. */
  point(shapes) {
    this.pointed = shapes;
    this.draw();
  }

  // ---- what part of the plane is seen

  /** Show all blocks. */
  fit() {
    this.eye.fit(this.shapes.bounds);
    this.fitted = true;
    this.draw();
  }

  /** Show what is selected as large as its surroundings allow; all blocks if nothing is. */
  approach() {
    const places = this.chosen.map((shape) => shape.box ?? [...centre(shape), ...centre(shape)]);
    const sound = places.filter((range) => range.every(Number.isFinite));
    if (!sound.length) {
      this.fit();
      return;
    }
    const range = [0, 1, 2, 3].map((k) => Math[k < 2 ? "min" : "max"](...sound.map((one) => one[k])));
    this.eye.approach(range, (0.5 * blockSize(this.shapes, this.eye)) / this.eye.scale);
    this.fitted = false;
    this.draw();
  }

  resized() {
    Object.assign(this.eye, { width: this.canvas.clientWidth, height: this.canvas.clientHeight });
    if (this.shapes && this.fitted) this.fit();
    this.draw();
  }

  zoom(...about) {
    this.eye.zoom(...about);
    this.fitted = false;
    this.draw();
  }

  closer() {
    this.zoom(FACTOR);
  }

  further() {
    this.zoom(1 / FACTOR);
  }

  // ---- events

  wheel(event) {
    event.preventDefault();
    this.zoom(event.deltaY < 0 ? FACTOR : 1 / FACTOR, event.offsetX, event.offsetY);
  }

  grasp(event) {
    this.held = { x: event.offsetX, y: event.offsetY, moved: false };
  }

  move(event) {
    if (!this.held) {
      this.over(event);
      return;
    }
    const [dx, dy] = [event.offsetX - this.held.x, event.offsetY - this.held.y];
    if (!this.held.moved && Math.hypot(dx, dy) < STILL) return;
    this.canvas.setPointerCapture(event.pointerId);
    this.held = { x: event.offsetX, y: event.offsetY, moved: true };
    this.eye.shift(dx, dy);
    this.fitted = false;
    this.draw();
  }

  /** A click selects the smallest thing there; another one the next, as a zone below a block. */
  release(event) {
    const { held } = this;
    this.held = null;
    if (!held || held.moved) return;
    const there = this.lying(event);
    const k = there.findIndex((shape) => this.chosen.includes(shape));
    if (there.length) this.on.select(there[(k + 1) % there.length].address);
  }

  leave() {
    this.held = null;
    this.hint.hidden = true;
  }

  over(event) {
    const [first] = this.lying(event);
    this.on.hover(first?.address ?? 0);
    this.hint.hidden = !first;
    if (!first) return;
    this.hint.style.left = `${Math.min(event.offsetX + 12, this.eye.width - this.hint.offsetWidth - 4)}px`;
    this.hint.style.top = `${Math.max(event.offsetY - 28, 0)}px`;
  }

  lying(event) {
    const place = this.eye.place(event.offsetX, event.offsetY);
    return this.shapes.lyingAt(...place, showsPoints(this.shapes, this.eye) ? REACH / this.eye.scale : 0);
  }

  key(event) {
    if (event.altKey || event.ctrlKey || event.metaKey) return;
    if (event.key === "+" || event.key === "=") this.closer();
    else if (event.key === "-") this.further();
    else if (event.key === "0") this.fit();
    else if (event.key === "z") this.approach();
    else if (WAYS[event.key]) this.step(WAYS[event.key]);
    else return;
    event.preventDefault();
  }

  /** Select the nearest shape of the same kind in a direction; the first block if nothing is selected. */
  step([wx, wy]) {
    const [from] = this.chosen;
    const all = this.shapes.of(from?.kind ?? "block");
    const [x, y] = from ? centre(from) : [NaN, NaN];
    let [nearest, best] = [from ? null : all[0], Infinity];
    for (const one of all) {
      const [dx, dy] = [centre(one)[0] - x, centre(one)[1] - y];
      const ahead = dx * wx + dy * wy;
      const aside = Math.abs(dx * wy - dy * wx);
      if (ahead > 0 && ahead >= aside && ahead + aside < best) [nearest, best] = [one, ahead + aside];
    }
    if (nearest) this.on.select(nearest.address);
  }

  // ---- drawing

  drawNow() {
    if (!this.shapes || !this.eye.width) return;
    const { pen } = prepared(this.canvas);
    const painter = new Painter(pen, colours(this.shapes.heap.table), this.shapes, this.eye, this.scale);
    const rings = [
      [this.chosen, 3],
      [painter.large ? this.near : [], 1],
      [this.found, 1],
      [this.pointed, 2],
    ];
    painter.draw(this.chosen, rings, this.faults, this.forces);
  }
}
