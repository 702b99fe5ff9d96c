"use strict";
// Evaluates a sheet in plain JavaScript. `program` is generated from the declaration that every other engine
// is generated from: its index sets and, for each column, functions of a row. Nothing here knows a model.

const STATUS = { OK: 0, INPUT: 1, DOMAIN: 2, NOROOT: 3, TWOROOTS: 4 };
const NOISE = 16 * Number.EPSILON; // the share of its terms below which rounding hides a form
const CODES = ["ok", "#INPUT!", "#DOMAIN!", "#NOROOT!", "#TWOROOTS!"];

// The rows of an index set, and for each index that formulas use the rows that it names.
function layOut(axis, layouts, labels, data) {
  const rows = {}, ordinals = {};
  let names = [];
  if (axis.kind === "pairs") {
    const parent = layouts[axis.of], first = [], second = [];
    for (let i = 0; i < parent.size; i++) {
      for (let j = i + 1; j < parent.size; j++) {
        first.push(i);
        second.push(j);
        names.push([...parent.labels[i], ...parent.labels[j]]);
      }
    }
    rows[axis.first] = first;
    rows[axis.second] = second;
  } else if (axis.kind === "repeat") {
    const parent = layouts[axis.of], count = data[axis.count][0], which = [], step = [];
    for (let row = 0; row < parent.size; row++) {
      for (let s = 1; s <= count; s++) {
        which.push(row);
        step.push(s);
        names.push([...parent.labels[row], s]);
      }
    }
    for (const index of Object.keys(parent.rows)) rows[index] = which.map((row) => parent.rows[index][row]);
    ordinals[axis.step] = step;
  } else {
    names = labels[axis.name].map((label) => [label]);
  }
  rows[axis.index] = names.map((_, row) => row);
  return { size: names.length, rows, ordinals, labels: names };
}

// Sums of several terms over the rows that are kept, each compensated (Neumaier): no engine may lose digits
// to the order of its additions.
function total(size, keep, count, terms) {
  const sum = new Float64Array(count), lost = new Float64Array(count), term = new Float64Array(count);
  for (let row = 0; row < size; row++) {
    if (keep && !keep[row]) continue;
    terms(row, term);
    for (let n = 0; n < count; n++) {
      const before = sum[n], after = before + term[n];
      lost[n] += Math.abs(before) >= Math.abs(term[n]) ? before - after + term[n] : term[n] - after + before;
      sum[n] = after;
    }
  }
  for (let n = 0; n < count; n++) {
    if (Number.isFinite(lost[n])) sum[n] += lost[n];
  }
  return sum;
}

// The only root of a form in its interval: counted first by the signs between turning points, then taken in
// fixed steps inside the bracket.
function solveRoot(root, row) {
  const [low, high, start, atLow, atHigh, ...turning] = root.ends(row);
  const places = [low], signs = [Math.sign(atLow)];
  for (const point of turning) {
    if (point > places[places.length - 1] && point < high) {
      places.push(point);
      signs.push(Math.sign(root.at(row, point)[0]));
    }
  }
  places.push(high);
  signs.push(Math.sign(atHigh));
  if (signs.some(Number.isNaN)) return null; // outside the domain
  const found = [];
  for (let n = 0; n + 1 < places.length; n++) {
    if (signs[n] * signs[n + 1] < 0) {
      found.push(root.value(row, polish(root, row, places[n], places[n + 1], signs[n + 1], start))[0]);
    }
  }
  return found;
}

function polish(root, row, left, right, rising, start) {
  let here = start > left && start < right ? start : (left + right) / 2;
  for (let n = 0; n < root.steps; n++) {
    const [f, step] = root.step(row, here);
    if (f === 0) break;
    if (f * rising > 0) right = here;
    else left = here;
    const there = here - step;
    here = there >= left && there <= right ? there : (left + right) / 2;
  }
  // A row that the steps left anywhere but where rounding leaves nothing of the form is bisected.
  const [f, terms] = root.noise(row, here);
  return Math.abs(f) <= NOISE * terms ? here : bisect(root, row, left, right, rising);
}

function bisect(root, row, left, right, rising) {
  for (;;) {
    const middle = left + (right - left) / 2;
    if (!(middle > left && middle < right)) return right;
    const side = root.at(row, middle)[0] * rising;
    if (Number.isNaN(side)) return NaN;
    if (side <= 0) left = middle;
    else right = middle;
  }
}

// All columns of a sheet. `labels` numbers the rows of the given index sets, `inputs` has the given columns in
// SI as arrays (of one number for a scalar); NaN is a missing datum.
function evaluateSheet(program, labels, inputs) {
  const data = { ...program.constants, ...inputs };
  const layouts = {}, value = {}, status = {}, roots = {}, counted = {};
  for (const axis of program.axes) layouts[axis.name] = layOut(axis, layouts, labels, data);
  for (const column of program.columns) {
    const size = column.axis === null ? 1 : layouts[column.axis].size;
    const out = new Float64Array(size).fill(NaN), codes = new Uint8Array(size);
    value[column.name] = out;
    status[column.name] = codes;
    if (column.kind === "given") {
      for (let row = 0; row < size; row++) {
        const datum = data[column.name][row];
        if (Number.isFinite(datum)) out[row] = datum;
        else codes[row] = STATUS.INPUT;
      }
      continue;
    }
    const keep = {}, sizes = {};
    for (const axis of program.axes) sizes[axis.name] = layouts[axis.name].size;
    for (const name of column.sums) {
      keep[name] = rowsKept(column, name, layouts, status);
      sizes[name] = keep[name].reduce((sum, kept) => sum + kept, 0);
      if (sizes[name] < layouts[name].size) (counted[column.name] ??= {})[name] = sizes[name];
    }
    const kernels = column.kernels(value, layouts, sizes, keep);
    for (let row = 0; row < size; row++) {
      codes[row] = inherited(column, row, layouts, status, keep);
      if (codes[row] !== STATUS.OK) continue;
      // What breaks a condition is outside the domain, whatever the rule would make of it.
      if (kernels.requires && !kernels.requires(row).every(Boolean)) {
        codes[row] = STATUS.DOMAIN;
        continue;
      }
      let number;
      if (column.kind === "root") {
        const found = solveRoot({ ...kernels, steps: column.steps }, row);
        if (found === null) codes[row] = STATUS.DOMAIN;
        else if (found.length === 0) codes[row] = STATUS.NOROOT;
        else if (found.length > 1) {
          codes[row] = STATUS.TWOROOTS;
          (roots[column.name] ??= {})[row] = found.sort((a, b) => a - b);
        } else number = found[0];
      } else {
        number = kernels.value(row)[0];
        if (column.positive && !(number > 0)) codes[row] = STATUS.DOMAIN;
      }
      if (codes[row] === STATUS.OK && !Number.isFinite(number)) codes[row] = STATUS.DOMAIN;
      if (codes[row] === STATUS.OK) out[row] = number;
    }
  }
  return { layouts, value, status, roots, counted };
}

// The rows of a summed index set whose cells all have values: one that has none must not take the sum with it.
function rowsKept(column, axis, layouts, status) {
  const keep = new Uint8Array(layouts[axis].size).fill(1);
  for (const [name, index, scope] of column.refs) {
    if (scope !== axis) continue;
    const rows = index === null ? null : layouts[axis].rows[index];
    for (let row = 0; row < keep.length; row++) {
      if (status[name][rows === null ? 0 : rows[row]] !== STATUS.OK) keep[row] = 0;
    }
  }
  return keep;
}

// The first error among the precedents; a sum has one only if none of its rows has a value.
function inherited(column, row, layouts, status, keep) {
  for (const [name, index, scope] of column.refs) {
    let code;
    if (index === null) code = status[name][0];
    else if (scope === column.axis) code = status[name][layouts[scope].rows[index][row]];
    else code = keep[scope].includes(1) ? STATUS.OK : status[name][layouts[scope].rows[index][0]];
    if (code !== STATUS.OK) return code;
  }
  return STATUS.OK;
}
