// What part of the plane a picture shows: a place in metres to a pixel, and back. The middle of the picture
// is at (x, y), a metre has `scale` pixels; y points up in the plane and down in the picture.

export class Eye {
  constructor() {
    Object.assign(this, { x: 0, y: 0, scale: 1, width: 0, height: 0 });
  }

  /** Show a range [x1, y1, x2, y2] as a whole. */
  fit([x1, y1, x2, y2]) {
    const scale = 0.92 * Math.min(this.width / (x2 - x1 || 1), this.height / (y2 - y1 || 1));
    Object.assign(this, { x: (x1 + x2) / 2, y: (y1 + y2) / 2, scale: scale || 1 });
  }

  /** Show what lies in a range [x1, y1, x2, y2] with some room around it, at least `least` metres wide. */
  approach([x1, y1, x2, y2], least) {
    const room = Math.max(0.25 * (x2 - x1), 0.25 * (y2 - y1), least / 2);
    this.fit([x1 - room, y1 - room, x2 + room, y2 + room]);
  }

  /** Make all greater by a factor; what lies at a pixel stays there. */
  zoom(factor, px = this.width / 2, py = this.height / 2) {
    const [x, y] = this.place(px, py);
    this.scale *= factor;
    const [newX, newY] = this.place(px, py);
    this.x += x - newX;
    this.y += y - newY;
  }

  /** Draw the picture aside by pixels. */
  shift(dx, dy) {
    this.x -= dx / this.scale;
    this.y += dy / this.scale;
  }

  pixel(x, y) {
    return [this.width / 2 + (x - this.x) * this.scale, this.height / 2 - (y - this.y) * this.scale];
  }

  place(px, py) {
    return [this.x + (px - this.width / 2) / this.scale, this.y - (py - this.height / 2) / this.scale];
  }

  /** True if any part of a range can be seen. */
  sees([x1, y1, x2, y2]) {
    const [left, low] = this.pixel(x1, y1);
    const [right, high] = this.pixel(x2, y2);
    return right >= 0 && left <= this.width && low >= 0 && high <= this.height;
  }
}
