// What both canvases need: their size in pixels, the colours of the style sheet, hatching and rings.

/** The colours that the style sheet gives, by name: kinds of groups (muted if it has none), ink, paper ... */
export function colours(table) {
  const style = getComputedStyle(document.documentElement);
  const names = [...table.spans.map(styleName), "ink", "paper", "muted", "rule", "fault"];
  const given = (name) => style.getPropertyValue(`--${name}`).trim();
  return Object.fromEntries(names.map((name) => [name, given(name) || given("muted")]));
}

/** The name of a kind of span as the style sheet spells it. */
export function styleName(kind) {
  return kind.replaceAll(" ", "-");
}

/** Give a canvas the pixels of the place that it fills; its context, and width and height in CSS pixels. */
export function prepared(canvas) {
  const { clientWidth: width, clientHeight: height } = canvas;
  const dense = window.devicePixelRatio || 1;
  const [wide, high] = [Math.round(width * dense), Math.round(height * dense)];
  if (canvas.width !== wide || canvas.height !== high) Object.assign(canvas, { width: wide, height: high });
  const pen = canvas.getContext("2d");
  pen.setTransform(dense, 0, 0, dense, 0, 0);
  pen.clearRect(0, 0, width, height);
  return { pen, width, height };
}

/** A colour between two, as #rrggbb: a share of the one, the rest of the other. */
export function mixed(one, other, share) {
  const parts = [one, other].map((colour) => [1, 3, 5].map((k) => parseInt(colour.slice(k, k + 2), 16)));
  const mean = parts[0].map((part, k) => Math.round(share * part + (1 - share) * parts[1][k]));
  return `#${mean.map((part) => part.toString(16).padStart(2, "0")).join("")}`;
}

/** Black or white, whichever is read more easily on a colour. */
export function inkOn(colour) {
  const [r, g, b] = [1, 3, 5].map((k) => (parseInt(colour.slice(k, k + 2), 16) / 255) ** 2.2);
  return 0.2126 * r + 0.7152 * g + 0.0722 * b > 0.18 ? "#000000" : "#ffffff";
}

/** A pattern of slanting lines. */
export function hatching(pen, colour) {
  const tile = document.createElement("canvas");
  tile.width = tile.height = 8;
  const lines = tile.getContext("2d");
  lines.strokeStyle = colour;
  lines.beginPath();
  for (const shift of [-8, 0, 8]) {
    lines.moveTo(shift, 8);
    lines.lineTo(shift + 8, 0);
  }
  lines.stroke();
  return pen.createPattern(tile, "repeat");
}

/** Stroke the present path so that it is seen on every colour. */
export function ringed(pen, colour, width) {
  pen.lineJoin = "round";
  pen.strokeStyle = colour.paper;
  pen.lineWidth = width + 3;
  pen.stroke();
  pen.strokeStyle = colour.ink;
  pen.lineWidth = width;
  pen.stroke();
}

/** The mark of a place that the checker complains of: a triangle of a size with an exclamation mark. */
export function warned(pen, colour, x, y, size) {
  pen.beginPath();
  pen.moveTo(x, y - size);
  pen.lineTo(x + size, y + 0.75 * size);
  pen.lineTo(x - size, y + 0.75 * size);
  pen.closePath();
  pen.fillStyle = colour.fault;
  pen.strokeStyle = colour.paper;
  pen.lineWidth = 1.5;
  pen.stroke();
  pen.fill();
  pen.fillStyle = inkOn(colour.fault);
  pen.font = `bold ${1.25 * size}px system-ui, sans-serif`;
  pen.textAlign = "center";
  pen.textBaseline = "middle";
  pen.fillText("!", x, y + 0.1 * size);
}

/** `draw` at the next frame, once however often it is asked for. */
export function framed(draw) {
  let waiting = false;
  return () => {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      draw();
    });
  };
}
