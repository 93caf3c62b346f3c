// What ties the parts together: the state that is shown, what is selected, and where one was before.
//
// The selection is the part of the page's address behind #, as in #at=412&state=2. So a link selects, back
// and forward lead through what was selected, and an address can be kept or sent. `at` is a word, or a
// variable of the common block.

import { comparable } from "./changes.js";
import { find } from "./find.js";
import { Heap } from "./heap.js";
import { HeapMap } from "./heapmap.js";
import { exact } from "./numbers.js";
import { Panel, cell, element } from "./panel.js";
import { Picture } from "./picture.js";
import { Scale, colourings, gradient } from "./scale.js";
import { Shapes } from "./shapes.js";
import { belongings, called, leadsFrom, named, whoPoints } from "./words.js";

const PAUSE = 400; // milliseconds that a state is shown while the states are played

const $ = (choice) => document.querySelector(choice);

class App {
  constructor() {
    this.table = JSON.parse($("#table").textContent);
    this.sources = [...document.querySelectorAll("script.state")];
    this.opened = this.sources.map(() => null);
    this.shown = 0; // number of the state, from 1 on
    this.picture = new Picture($("#picture canvas"), $("#picture .hint"), this.events("#picture"));
    this.map = new HeapMap(
      $("#heap .scroll"),
      $("#heap canvas"),
      $("#heap .all"),
      $("#heap .hint"),
      this.events("#heap"),
    );
    this.panel = new Panel($("#found"), $("#chosen"), $("#about"), (addresses) => this.list(addresses));
    this.offerColours();
    this.listen();
  }

  /** What a canvas calls. */
  events(part) {
    return {
      select: (address) => this.go(address),
      hover: (address) => this.hover($(`${part} .hint`), address),
    };
  }

  // ---- states

  /** Words and shapes of a state, made when it is first shown. Promise. */
  open(number) {
    const k = number - 1;
    this.opened[k] ??= Heap.open(this.table, JSON.parse(this.sources[k].textContent)).then((heap) => {
      return { heap, shapes: new Shapes(heap) };
    });
    return this.opened[k];
  }

  /** Show a state, with what has changed since the one before it. */
  show(number, { heap, shapes }, former) {
    const before = comparable(heap, former);
    const wrong = heap.state.faults.flatMap(([, message]) => named(message));
    const spans = new Set(wrong.map((address) => heap.spanOf(address)).filter((span) => span >= 0));
    Object.assign(this, { heap, shapes, shown: number });
    this.picture.show(shapes, [...new Set(wrong)]);
    this.paint();
    this.map.show(heap, before, spans);
    this.panel.show(heap, before, number);
    this.showState(former && !before);
    this.showLegend(before);
  }

  showState(foreign) {
    const { heap, shown, sources } = this;
    const many = sources.length;
    const place = many > 1 ? `${shown} of ${many}: ` : "";
    const time = Number(heap.variable("TIME").toPrecision(5));
    const other = foreign ? ", not compared: other words than before" : "";
    $("#name").textContent = $("#name").title = heap.state.name;
    $("#state").textContent =
      `${place}cycle ${heap.variable("MCTOT")}, t = ${time} s, ${heap.state.scheme}${other}`;
    $("#states").hidden = many < 2;
    Object.assign($("#slider"), { max: many, value: shown, ariaValueText: `${shown}, ${heap.state.name}` });
    $("#before").disabled = shown === 1;
    $("#after").disabled = shown === many;
  }

  // ---- how the blocks are drawn

  /** The fields that areas can be coloured by. */
  offerColours() {
    for (const { kind, words } of colourings(this.table)) {
      const options = words.map(({ name, field }) =>
        element("option", { value: `${kind}.${name}`, title: field.text }, name),
      );
      $("#colour").append(element("optgroup", { label: kind }, ...options));
    }
    $("#range .bar").style.background = gradient();
  }

  /** Colour areas by the field that is chosen, with a key, and draw forces if they are wanted. */
  paint() {
    const [kind, name] = $("#colour").value.split(".");
    const scale = name ? new Scale(this.heap, kind, name) : null;
    const bits = this.heap.state.reals;
    const [low, high] = scale ? [scale.low, scale.high].map((value) => exact(Number(value.toPrecision(4)), bits)) : [];
    const known = scale && scale.low <= scale.high;
    $("#range").hidden = !scale;
    $("#range .bar").hidden = !known;
    $("#range .low").textContent = known ? low : `no ${kind} has a number`;
    $("#range .high").textContent = known ? `${high} ${scale.word.field.unit}` : "";
    this.picture.paint(scale, $("#forces").checked);
  }

  /** Ring the groups of a list in the picture. */
  list(addresses) {
    this.picture.list(addresses.map((address) => this.shapes.at.get(address)).filter(Boolean));
  }

  /** The kinds that there are, with how many; a click lists them. */
  showLegend(before) {
    const { heap } = this;
    const there = this.table.spans.filter((kind) => heap.groups[kind].length);
    const items = there.map((kind) => {
      const known = kind in this.table.kinds;
      const text = known ? `${kind} ${heap.groups[kind].length}` : kind;
      const name = known ? element("button", { type: "button", onclick: () => this.find(kind) }, text) : text;
      return element("li", {}, cell(kind), name);
    });
    const marks = ["● it points there", "○ points to it", ...(before ? ["▂ changed"] : [])];
    $("#legend").replaceChildren(...items, ...marks.map((text) => element("li", {}, text)));
  }

  // ---- selection

  /** Select an address, or a variable of the common block. */
  go(at, state = this.shown) {
    location.hash = `at=${at}&state=${state}`;
  }

  /** Show another state, the selection as it is. */
  turn(number) {
    if (number < 1 || number > this.sources.length || number === this.coming) return;
    const given = new URLSearchParams(location.hash.slice(1));
    given.set("state", number);
    history.replaceState(history.state, "", `#${given}`);
    return this.follow();
  }

  /** Show the states one after the other, from the first one on if the last one is shown; again: stop. */
  async play() {
    this.playing = !this.playing;
    $("#play").textContent = this.playing ? "❚❚" : "▶▶";
    if (this.playing && this.shown === this.sources.length) await this.turn(1);
    while (this.playing && this.shown < this.sources.length) {
      await new Promise((done) => setTimeout(done, PAUSE));
      if (this.playing) await this.turn(this.shown + 1);
    }
    if (this.playing) await this.play();
  }

  /** Show what the page's address says, unless it says something else by the time that it could be shown. */
  async follow() {
    const given = new URLSearchParams(location.hash.slice(1));
    const wanted = Math.trunc(Number(given.get("state")));
    const number = wanted >= 1 && wanted <= this.sources.length ? wanted : this.shown || 1;
    this.coming = number;
    const [opened, former] = await Promise.all([
      this.open(number),
      number > 1 ? this.open(number - 1) : null,
    ]);
    if (this.coming !== number) return;
    if (number !== this.shown) this.show(number, opened, former?.heap ?? null);
    const at = given.get("at") ?? "";
    const address = Math.trunc(Number(at)) || 0;
    this.mark(address);
    this.panel.choose(address, address || !at ? undefined : at);
  }

  /** Light up an address in both pictures. */
  mark(address) {
    const { heap, shapes } = this;
    const span = heap.spanOf(address);
    const near = span < 0 ? [] : belongings(heap, span);
    const from =
      span < 0
        ? []
        : whoPoints(heap, span)
            .map((one) => one.span)
            .filter((one) => one >= 0);
    const chosen = span < 0 ? [] : shapes.standFor(span);
    const word = span >= 0 && address !== heap.first[span] ? address : 0;
    this.map.mark(span, word, near, span < 0 ? [] : leadsFrom(heap, span), [...new Set(from)]);
    const close = near
      .map((one) => shapes.at.get(heap.first[one]))
      .filter((one) => one && one.kind !== "zone");
    this.picture.mark(chosen, close);
  }

  // ---- where one was

  /** Keep the number of each place in the browser's history, so that the buttons know where it ends. */
  note() {
    const known = history.state?.place;
    this.place = known ?? (this.place ?? -1) + 1;
    this.end = known === undefined ? this.place : Math.max(this.end ?? 0, known);
    history.replaceState({ place: this.place }, "");
    $("#back").disabled = this.place === 0;
    $("#forward").disabled = this.place === this.end;
  }

  // ---- events

  listen() {
    addEventListener("hashchange", () => this.moved());
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.redraw());
    $("#back").onclick = () => history.back();
    $("#forward").onclick = () => history.forward();
    $("#before").onclick = () => this.turn(this.shown - 1);
    $("#after").onclick = () => this.turn(this.shown + 1);
    $("#play").onclick = () => this.play();
    $("#colour").onchange = () => this.paint();
    $("#forces").onchange = () => this.paint();
    $("#picture [data-zoom=chosen]").onclick = () => this.picture.approach();
    $("#slider").oninput = (event) => this.turn(Number(event.target.value));
    $("#find").onsubmit = (event) => {
      event.preventDefault();
      this.find($("#query").value);
    };
    for (const [part, view] of [
      ["#picture", this.picture],
      ["#heap", this.map],
    ]) {
      $(`${part} [data-zoom=in]`).onclick = () => view.closer();
      $(`${part} [data-zoom=out]`).onclick = () => view.further();
      $(`${part} [data-zoom=fit]`).onclick = () => view.fit();
    }
    const panel = $("#panel");
    for (const name of ["pointerover", "focusin"])
      panel.addEventListener(name, (event) => this.point(event.target));
    for (const name of ["pointerleave", "focusout"]) panel.addEventListener(name, () => this.point(null));
    addEventListener("keydown", (event) => this.key(event));
    const names = Object.values(this.table.kinds).flatMap((kind) => kind.fields.map((field) => field.name));
    const known = [
      ...Object.keys(this.table.kinds),
      ...new Set(names),
      ...this.table.common.map((field) => field.name),
    ];
    $("#queries").append(...known.map((value) => element("option", { value })));
  }

  moved() {
    this.note();
    return this.follow();
  }

  redraw() {
    this.picture.draw();
    this.map.draw();
  }

  key(event) {
    if (/^(INPUT|SELECT)$/.test(event.target.tagName) || event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === "/") $("#query").focus();
    else if (event.key === "[") this.turn(this.shown - 1);
    else if (event.key === "]") this.turn(this.shown + 1);
    else if (event.key === "p" && this.sources.length > 1) this.play();
    else return;
    event.preventDefault();
  }

  /** Say what the mouse is on. */
  hover(hint, address) {
    const span = this.heap?.spanOf(address) ?? -1;
    if (span < 0) return;
    const onWord = hint.closest("#heap") && this.heap.isGroup(span);
    const word = onWord && this.heap.words(span).find((one) => one.first <= address && address <= one.last);
    const value = word
      ? `, ${word.name} = ${exact(this.heap.value(word), this.heap.state.reals)} ${word.field.unit}`
      : "";
    hint.textContent = called(this.heap, span) + value;
  }

  /** Ring what a link of the panel leads to. */
  point(target) {
    const address = Number(target?.closest?.("[data-address]")?.dataset.address);
    const span = address ? this.heap.spanOf(address) : -1;
    this.map.point(span);
    this.picture.point(span < 0 ? [] : this.shapes.standFor(span));
  }

  find(query) {
    const found = find(this.heap, query);
    this.say(found.note ?? "");
    if (found.list) this.panel.find(found.list);
    if (found.common) this.go(found.common);
    if (found.go) this.go(found.go);
  }

  say(text) {
    $("#message").textContent = text;
    $("#message").hidden = !text;
  }
}

const app = new App();
app.moved().catch((error) => app.say(`This page cannot be shown: ${error.message}`));
