// Conditions on groups, as `udec find` takes them: block where KXD > 0.1 and KMAT == 2. Here they are read by
// descent, or before and before not, comparisons, sums, products and signs. Each part becomes a function of the
// address of a group, which gives a number or a truth value. A comparison with what a pointer does not lead to
// is false.

import { elements } from "./heap.js";

const TOKEN = /\s*(?:(\d+\.?\d*(?:[eE][+-]?\d+)?|\.\d+(?:[eE][+-]?\d+)?)|(abs\b|[A-Za-z]\w*(?:\(\d+\))?)|(<=|>=|==|!=|[-+*/<>().])|(\S))/gy;
const COMPARED = {
  "<": (a, b) => a < b,
  "<=": (a, b) => a <= b,
  "==": (a, b) => a === b,
  "!=": (a, b) => a !== b,
  ">=": (a, b) => a >= b,
  ">": (a, b) => a > b,
};
const CALCULATED = {
  "+": (a, b) => a + b,
  "-": (a, b) => a - b,
  "*": (a, b) => a * b,
  "/": (a, b) => a / b,
};
const DEPTH = 60; // brackets and signs within each other

/** The kind of group that a text names, in singular or plural; undefined for another word. */
export function kindNamed(table, text) {
  const word = text.toLowerCase().replaceAll("-", "");
  const singulars = [word, word.replace(/s$/, ""), word.replace(/es$/, ""), word.replace(/ies$/, "y")];
  return singulars.find((one) => Object.hasOwn(table.kinds, one));
}

/** The group behind a pointer field of groups of some kinds, and its field, as { field, read }.
 * steps: names of fields, as KB1 and KXD of KB1.KXD; read: a function of an address that gives the word at the
 * end, undefined if a pointer does not lead so far. Throws what is wrong. */
export function path(heap, kind, steps) {
  let kinds = [kind];
  const links = steps.map((name, k) => {
    const found = kinds.map((one) => [one, heap.table.kinds[one].fields.flatMap(elements).find((of) => of.name === name)]);
    const words = new Map(found.filter(([, one]) => one));
    if (!words.size) throw new Error(`a ${kinds.join(" or ")} has no field ${name}`);
    const targets = [...words.values()].flatMap(({ field }) =>
      field.target ? (heap.table.choices[field.target] ?? [field.target]) : [],
    );
    if (k + 1 < steps.length && !targets.length) throw new Error(`${name} is not a pointer: nothing can follow it`);
    kinds = targets;
    return words;
  });
  const read = (start) => {
    let [address, word] = [start, undefined];
    for (const words of links) {
      if (word) address = Number(heap.value(word));
      const of = [...words.keys()].find((one) => (word ? heap.holds(one, address) : one === kind));
      if (!of) return undefined;
      word = heap.word(of, words.get(of), address);
    }
    return word;
  };
  return { field: links[links.length - 1].values().next().value.field, read };
}

/** A condition on groups of a kind: { test, columns }: a function of an address, and the fields it names as
 * { name, field, read }. Throws an Error that says what is wrong, and before what. */
export function condition(heap, kind, text) {
  const parser = new ConditionParser(heap, kind, text);
  const whole = parser.parseOr();
  if (parser.token) parser.fail("this cannot be understood");
  return { test: parser.truth(whole).at, columns: [...parser.columns.values()] };
}

class ConditionParser {
  constructor(heap, kind, text) {
    Object.assign(this, { heap, kind, text, columns: new Map(), depth: 0, before: 0 });
    TOKEN.lastIndex = 0;
    this.next();
  }

  /** Go to the next token: { number }, { name }, { sign } or null at the end. */
  next() {
    this.before = TOKEN.lastIndex;
    const found = this.before < this.text.trimEnd().length ? TOKEN.exec(this.text) : null;
    const [, number, name, sign, wrong] = found ?? [];
    this.token = found && { number, name, sign: sign ?? wrong };
  }

  fail(reason, at = this.before) {
    const rest = this.text.slice(at).trim();
    throw new Error(`${reason}${rest ? `, at: ${rest}` : ", at the end"}`);
  }

  /** True, and past it, if a word or a sign is next. */
  accept(what) {
    const there = this.token && (this.token.sign === what || this.token.name === what);
    if (there) this.next();
    return Boolean(there);
  }

  truth(part) {
    if (!part.isTruth) this.fail("this is a number, neither true nor false: compare it, such as with != 0", part.begin);
    return part;
  }

  number(part) {
    if (part.isTruth) this.fail("this is true or false, and no number", part.begin);
    return part;
  }

  part(begin, isTruth, at) {
    return { begin, isTruth, at };
  }

  parseOr() {
    let one = this.parseAnd();
    while (this.accept("or")) {
      const [a, b] = [this.truth(one), this.truth(this.parseAnd())];
      one = this.part(a.begin, true, (address) => a.at(address) || b.at(address));
    }
    return one;
  }

  parseAnd() {
    let one = this.parseNot();
    while (this.accept("and")) {
      const [a, b] = [this.truth(one), this.truth(this.parseNot())];
      one = this.part(a.begin, true, (address) => a.at(address) && b.at(address));
    }
    return one;
  }

  parseNot() {
    const begin = this.before;
    if (!this.accept("not")) return this.parseComparison();
    const one = this.nested(() => this.truth(this.parseNot()));
    return this.part(begin, true, (address) => !one.at(address));
  }

  parseComparison() {
    const first = this.parseSum();
    const others = [];
    while (this.token && Object.hasOwn(COMPARED, this.token.sign ?? "")) {
      const compare = COMPARED[this.token.sign];
      this.next();
      others.push([compare, this.number(this.parseSum())]);
    }
    if (!others.length) return first;
    this.number(first);
    return this.part(first.begin, true, (address) => {
      let left = first.at(address);
      const values = others.map(([, right]) => right.at(address));
      if (left === undefined || values.includes(undefined)) return false;
      return others.every(([compare], k) => {
        const holds = compare(left, values[k]);
        left = values[k];
        return holds;
      });
    });
  }

  parseSum() {
    return this.parseOperations(["+", "-"], () => this.parseOperations(["*", "/"], () => this.parseSign()));
  }

  parseOperations(signs, operand) {
    let one = operand();
    while (this.token && signs.includes(this.token.sign)) {
      const calculate = CALCULATED[this.token.sign];
      this.next();
      const [a, b] = [this.number(one), this.number(operand())];
      one = this.part(a.begin, false, (address) => {
        const [x, y] = [a.at(address), b.at(address)];
        return x === undefined || y === undefined ? undefined : calculate(x, y);
      });
    }
    return one;
  }

  parseSign() {
    const begin = this.before;
    if (this.accept("-")) {
      const one = this.nested(() => this.number(this.parseSign()));
      return this.part(begin, false, (address) => this.apply(one.at(address), (x) => -x));
    }
    return this.accept("+") ? this.nested(() => this.number(this.parseSign())) : this.parseOperand();
  }

  apply(value, change) {
    return value === undefined ? undefined : change(value);
  }

  parseOperand() {
    const begin = this.before;
    const { number, name } = this.token ?? {};
    if (this.accept("(")) {
      const one = this.nested(() => this.parseOr());
      if (!this.accept(")")) this.fail("a bracket is not closed", begin);
      return { ...one, begin };
    }
    if (number !== undefined) {
      this.next();
      return this.part(begin, false, () => Number(number));
    }
    if (name === undefined || ["and", "or", "not"].includes(name)) this.fail("here is a field or a number missing");
    this.next();
    if (name === "abs") {
      if (!this.accept("(")) this.fail("abs needs a bracket", begin);
      const one = this.nested(() => this.number(this.parseOr()));
      if (!this.accept(")")) this.fail("a bracket is not closed", begin);
      return this.part(begin, false, (address) => this.apply(one.at(address), Math.abs));
    }
    return this.part(begin, false, this.parseName(name, begin));
  }

  /** What a name stands for: the address, a code, a field, or a field of the group that a pointer leads to. */
  parseName(name, begin) {
    const steps = [name];
    while (this.accept(".")) {
      if (this.token?.name === undefined) this.fail("after the point give a field");
      steps.push(this.token.name);
      this.next();
    }
    if (name === "address" && steps.length === 1) return (address) => address;
    const code = steps.length === 1 ? codes(this.heap.table).get(name) : undefined;
    if (code !== undefined) return () => code;
    let found;
    try {
      found = path(this.heap, this.kind, steps);
    } catch (error) {
      this.fail(error.message, begin);
    }
    const { field, read } = found;
    const whole = steps.join(".");
    const value = (address) => this.apply(read(address), (word) => this.heap.value(word));
    this.columns.set(whole, { name: whole, field, read: value });
    return (address) => this.apply(value(address), Number);
  }

  nested(read) {
    this.depth += 1;
    if (this.depth > DEPTH) this.fail("this is nested too deep");
    const one = read();
    this.depth -= 1;
    return one;
  }
}

/** Values of head codes and codes, by name. */
function codes(table) {
  const named = (text) => text.split(":")[0];
  const heads = table.heads.map(([, value, text]) => [named(text), value]);
  return new Map([...heads, ...table.codes.map(([, value, text]) => [named(text), value])]);
}
