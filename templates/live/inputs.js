// The inputs: what was printed, how a text becomes a number, and the states that can be undone.
// Nothing in this file knows the page.

// What people write for a number, in our notation: a decimal comma becomes a point, a real minus a hyphen.
// Nobody knows whether 1,234 is a little more than one or a thousand, unless the other numbers of a block tell.
const EITHER = /^[+-]?[1-9]\d{0,2},\d{3}$/;
const GROUPED = /^[+-]?[1-9]\d{0,2}(([.,])\d{3})(\2\d{3})*$/;
// In parentheses behind a number stands its standard uncertainty, in units of its last digit.
const CONCISE = /^([^()]*)\((\d+)\)$/;

// What is no number even so stays as it was typed: without its comma “200.0, exact” would be a number but for a word.
function normalised(text, commas) {
  const read = inOurNotation(text, commas);
  return NUMBER.test(CONCISE.exec(read)?.[1] ?? read) ? read : text.trim();
}

function inOurNotation(text, commas = false) {
  // A blank or a mark groups digits by three, or it is no part of a number.
  const plain = text.trim().replace(/(\d)[\s\u00a0\u2007\u202f'_](?=\d{3}(?!\d))/g, "$1").replace(/[\u2212\u2013]/g, "-");
  const comma = plain.lastIndexOf(","), point = plain.lastIndexOf(".");
  if (comma < 0 || plain.indexOf(",") !== comma && point < 0 || !commas && EITHER.test(plain)) return plain;
  // Of comma and point together, the last is the decimal sign and the others group digits, by three.
  const at = Math.max(comma, point), whole = plain.slice(0, at);
  return point < 0 || GROUPED.test(whole) ? `${whole.replace(/[.,]/g, "")}.${plain.slice(at + 1)}` : plain;
}

const LARGEST = tenTo(300);
const isLess = (a, b) => a.n * b.d < b.n * a.d;
const isSane = ({ n, d }) => magnitude(n) <= LARGEST * d && magnitude(n) * LARGEST >= d;

// A printed text as the value of an input in SI: { value }, with one unit of its last digit and what is stated of its
// errors, or { why } there is none. Where a column states them and says nothing of this row, they are unknown.
function readInput({ given, errors, unit }, index, text) {
  const concise = given.bounds.integer ? null : CONCISE.exec(text), digits = concise ? concise[1] : text;
  const own = Array.isArray(errors) ? errors : errors?.[index];
  const stated = concise && !errors?.length ? [{ digits: Number(concise[2]), shape: "normal" }] : own;
  const unknown = given.u && !own ? UNKNOWN : undefined; // until it is typed
  const refused = (why, what = `“${text}” `) => ({ why: `${what}${why}; it must be ${given.allowed}` });
  if (text === "") return refused("the datum is missing", "");
  const found = NUMBER.exec(digits), alone = given.bounds.integer || given.said && !unknown || errors?.length ? "" : ", or as 46.7(5) with its u in units of the last digit";
  const meant = EITHER.test(text) ? `: write ${text.replace(",", ".")} or ${text.replace(",", "")}, whichever is meant`
    : /^[-+.]?\d/.test(text) ? `: write it alone${unit === "1" ? "" : `, in ${unit}`}${alone}` : "";
  if (!found) return refused(`is not a number${meant}`);
  if (text.length > 100 || Math.abs(Number(found[5] ?? 0)) > 300) return refused("is out of all range");
  if (concise && given.said && !unknown) return { why: `“${text}” says how sure it is, and so does ${given.said}: write ${digits}` };
  if (typeof stated === "string") return { why: `“${stated}” in ${given.said} is not a standard uncertainty of at least 0` };
  const exact = readExact(digits), [n, d, zero = 0n] = given.scale.map(BigInt);
  const value = { n: exact.n * n + zero * exact.d, d: exact.d * d };
  // Its last digit is asked for, too: from it comes the uncertainty.
  const places = decimalsOf(digits), digit = places < 0 ? { n: n * tenTo(-places), d } : { n, d: d * tenTo(places) };
  if (!isSane(digit) || (value.n !== 0n && !isSane(value))) return refused("is out of all range");
  const { low, high, low_open, high_open, integer } = given.bounds;
  const wrong = [
    integer && value.n % value.d !== 0n,
    low !== undefined && (isLess(value, readExact(low)) || (low_open && !isLess(readExact(low), value))),
    high !== undefined && (isLess(readExact(high), value) || (high_open && !isLess(value, readExact(high)))),
  ];
  if (wrong.some(Boolean)) return refused("is not allowed");
  return { value: toDouble(value), digit: toDouble(digit), stated: stated ?? unknown };
}

// The errors of a given number, with their standard uncertainties in SI: those that were stated of its column, or of
// its row alone, else that of its digits. What is a share of the value or of its last digit follows what is typed.
const OF_DIGITS = [{ digits: 1 / Math.sqrt(12), shape: "rectangular" }];
const UNKNOWN = [{ ...OF_DIGITS[0], unknown: true }]; // so large it is only to see what it moves
const isUnknown = (...input) => readInput(...input).stated === UNKNOWN;

function errorsOf(column, index, text) {
  const { value, digit, stated = OF_DIGITS } = readInput(column, index, text);
  const sized = stated.map(({ u = 0, share = 0, digits = 0, ...more }) => ({ ...more, u: u + share * Math.abs(value) + digits * digit }));
  return sized.filter(({ u }) => u); // none of what is no number
}

// How much more than it says a number is expected to be, in SI: of a truncated one half a unit of its last digit.
function expected(column, index, text) {
  const { digit, stated } = readInput(column, index, text);
  return column.given.truncated && !stated ? (text.startsWith("-") ? -0.5 : 0.5) * digit : 0;
}

// --- states ----------------------------------------------------------------------------------------------
// A state is { tables: { tests: [{ label, used, reason, cells: { v: "2.334" } }] }, parameters: { beta: "1.5" } } and is
// never changed: an edit makes a new one. A table is known by its index set; the reason is why a test is not used.

const copied = (state) => structuredClone(state);
const sameState = (a, b) => JSON.stringify(a) === JSON.stringify(b);
const usedTests = (state, axis) => state.tables[axis].filter((test) => test.used);
const testAt = (state, axis, label) => state.tables[axis].find((one) => String(one.label) === String(label));

class History {
  constructor(issued) {
    this.issued = issued;
    this.states = [issued];
    this.place = 0;
  }

  get now() {
    return this.states[this.place];
  }

  // As many steps as are asked for, up to now.
  last(count) {
    return this.states.slice(Math.max(1, this.place + 1 - count), this.place + 1);
  }

  push(state) {
    if (sameState(state, this.now)) return false;
    this.states.splice(this.place + 1, Infinity, state);
    this.place += 1;
    return true;
  }

  move(step) {
    if (!this.states[this.place + step]) return false;
    this.place += step;
    return true;
  }
}

// How many inputs differ from the report as issued.
function differences(state, issued) {
  let count = 0;
  for (const axis of Object.keys(issued.tables)) {
    const before = new Map(issued.tables[axis].map((test) => [test.label, test]));
    count += before.size;
    for (const test of state.tables[axis]) {
      const old = before.get(test.label);
      if (!old) {
        count += 1;
        continue;
      }
      count += (test.used !== old.used || test.reason !== old.reason) - 1;
      for (const name of Object.keys(test.cells)) count += test.cells[name] !== old.cells[name];
    }
  }
  for (const name of Object.keys(state.parameters)) count += state.parameters[name] !== issued.parameters[name];
  return count;
}

// --- the sheet of a state --------------------------------------------------------------------------------

// Reads the inputs and computes every column: what evaluateSheet returns, with what it was given and why inputs were
// refused. Where rows stand in groups, the number of each test's is told.
function computeSheet(program, columns, state, groups) {
  const labels = {}, data = {}, refused = {};
  for (const { name, kind, of } of program.axes) {
    if (kind === "given") labels[name] = usedTests(state, name).map((test) => test.label);
    if (kind === "members") labels[name] = usedTests(state, of).map((test) => groups[name][test.label]);
  }
  for (const { name, axis, kind } of program.columns) {
    if (kind !== "given" || program.constants[name]) continue;
    const { of } = columns[name], tests = axis === null ? [] : usedTests(state, axis);
    if (of) {
      data[name] = tests.map(({ label, cells }) => {
        const input = [columns[of], label, cells[of]];
        return readInput(...input).why || isUnknown(...input) ? NaN : Math.hypot(...errorsOf(...input).map(({ u }) => u));
      });
      continue;
    }
    const texts = axis === null ? [["", state.parameters[name]]] : tests.map(({ label, cells }) => [label, cells[name]]);
    data[name] = texts.map(([index, text], row) => {
      const read = readInput(columns[name], index, text);
      if (read.why) (refused[name] ??= {})[row] = read.why;
      return read.why ? NaN : read.value;
    });
  }
  return { ...evaluateSheet(program, labels, data), labels, data, refused };
}
