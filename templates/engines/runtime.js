"use strict";
// Evaluates a sheet in plain JavaScript. `program` is generated from the declaration that every other engine
// is generated from: its index sets and, for each column, functions of a row. Nothing here knows a model.

const STATUS = { OK: 0, INPUT: 1, DOMAIN: 2, NOROOT: 3, TWOROOTS: 4, OVERFLOW: 5, UNDECIDED: 6 };
const BLOCK = 16; // rows that a sum adds as they come
const CODES = ["ok", "#INPUT!", "#DOMAIN!", "#NOROOT!", "#TWOROOTS!", "#OVERFLOW!", "#UNDECIDED!"];
const SMALLEST = 2 ** -1022; // the least positive number with all its digits

// The rows of an index set, and for each index that formulas use the rows that it names.
function layOut(axis, layouts, labels, data) {
  const rows = {}, ordinals = {}, parent = layouts[axis.of];
  let size, label, starts;
  if (axis.kind === "pairs") {
    const first = (rows[axis.first] = []), second = (rows[axis.second] = []);
    for (let i = 0; i < parent.size; i++) {
      for (let j = 0; j < parent.size; j++) {
        if (axis.chosen(i + 1, j + 1)) first.push(i), second.push(j);
      }
    }
    size = first.length;
    label = (row) => [...parent.labels[first[row]], ...parent.labels[second[row]]];
  } else if (axis.kind === "repeat") {
    const count = data[axis.count][0] || 0; // a count that was refused is NaN: no rows
    const step = (ordinals[axis.step] = new Float64Array((size = parent.size * count)));
    for (let row = 0; row < size; row++) step[row] = (row % count) + 1;
    for (const index of Object.keys(parent.rows)) {
      const named = parent.rows[index], every = (rows[index] = new Int32Array(size));
      for (let row = 0, of = 0; of < parent.size; of++) every.fill(named[of], row, (row += count));
    }
    label = (row) => [...parent.labels[Math.floor(row / count)], step[row]];
  } else if (axis.kind === "members") {
    // The rows of a group stand beside one another.
    const group = labels[axis.name], own = Array.from(group, (_, row) => row).sort((a, b) => group[a] - group[b]);
    for (const index of Object.keys(parent.rows)) rows[index] = own.map((row) => parent.rows[index][row]);
    size = own.length;
    starts = [...own.keys(), size].filter((row) => group[own[row]] !== group[own[row - 1]]);
    label = (row) => [group[own[row]], ...parent.labels[own[row]]];
  } else if (axis.kind === "groups") {
    size = parent.starts.length - 1;
    label = (row) => [parent.labels[parent.starts[row]][0]];
  } else if (axis.kind === "counted") {
    const step = (ordinals[axis.step] = new Float64Array((size = axis.number)).map((_, row) => row + 1));
    label = (row) => [step[row]];
  } else {
    size = labels[axis.name].length;
    label = (row) => [labels[axis.name][row]];
    for (const index in axis.groups) {
      const group = labels[axis.groups[index]], every = [...new Set(group)].sort((a, b) => a - b);
      rows[index] = group.map((number) => every.indexOf(number));
    }
  }
  const own = (rows[axis.index] = new Int32Array(size).map((_, row) => row));
  let named; // What rows are called is asked for seldom, and of the largest set hardly ever.
  return { size, rows, ordinals, starts, get labels() { return (named ??= Array.from(own, label)); } };
}

// Sums of several terms over the rows that are kept. Of a few rows `terms` adds them as they come, then every
// addition is compensated (Neumaier, with Knuth's sum of two): no engine may lose digits to the order of its
// additions. Infinite is no number, so that a formula which divides by it is none.
function total(kept, count, terms, first = 0, end = kept.length) {
  const sum = new Float64Array(count), lost = new Float64Array(count);
  for (let row = first; row < end; row += BLOCK) {
    const part = terms(row, Math.min(row + BLOCK, end), kept);
    for (let n = 0; n < count; n++) {
      const term = part[n], before = sum[n], added = (sum[n] += term) - before;
      lost[n] += before - (sum[n] - added) + (term - added);
    }
  }
  return sum.map((all, n) => all + lost[n]);
}

// The same over the rows of each group: for each of the terms an array of sums.
function totals(kept, count, terms, starts) {
  const every = starts.slice(1).map((end, group) => total(kept, count, terms, starts[group], end));
  return Array.from(new Float64Array(count), (_, n) => every.map((sums) => sums[n]));
}

// What is taken of the rows of each group, all others left out.
function ofGroups(kept, starts, take) {
  return starts.slice(1).map((end, group) => take(kept.map((own, row) => own && row >= starts[group] && row < end)));
}

// The middle of the terms of the rows that are kept; of an even number, the mean of the two there.
function median(kept, term) {
  const all = new Float64Array(kept).map((_, row) => term(row)).filter((_, row) => kept[row]).sort(), { length } = all;
  return (all[(length - 1) >> 1] + all[length >> 1]) / 2;
}

// The only root of a form in its interval: counted first by the signs between turning points, or with intervals
// where nothing is known of those, then halved out of the bracket.
function solveRoot(root, row) {
  const [low, high, atLow, atHigh, ...turning] = root.ends(row);
  const places = [low], signs = [Math.sign(atLow ?? root.at(row, low))];
  for (const point of turning) {
    if (point > places[places.length - 1] && point < high) {
      places.push(point);
      signs.push(Math.sign(root.at(row, point)));
    }
  }
  places.push(high);
  signs.push(Math.sign(atHigh ?? root.at(row, high)));
  if (signs.some(Number.isNaN)) return null; // outside the domain
  const brackets = root.isolate
    ? root.isolate(root, row, low, high, [atLow, atHigh])
    : signs.flatMap((sign, n) => (sign * signs[n - 1] < 0 ? [[places[n - 1], places[n], sign]] : []));
  return brackets[0] === null ? brackets : brackets.map(([left, right, rising]) => root.value(row, (root.unknown = bisect(root, row, left, right, rising))));
}

// Closes a bracket until no double lies within, and gives its upper end. The line through both ends is asked where it
// crosses zero, and a little beyond, so that the bracket closes from both sides; what twice did not halve it is halved.
function bisect(root, row, left, right, rising) {
  for (let below = NaN, above = NaN, idle = 0; ; ) {
    const wide = right - left, middle = left + wide / 2, size = Math.abs(middle);
    if (!(middle > left && middle < right)) return right;
    const crossing = left - (below / (above - below)) * wide, near = Math.min(crossing - left, right - crossing);
    const beyond = Math.max(size * 2 ** -51, near * Math.min(0.1, wide / size));
    let at = crossing < middle ? crossing + beyond : crossing - beyond;
    if (idle > 1 || !(at > left && at < right)) at = middle;
    const side = root.at(row, at) * rising;
    if (Number.isNaN(side)) return NaN;
    if (side <= 0) [left, below] = [at, side];
    else [right, above] = [at, side];
    idle = 2 * (right - left) > wide ? idle + 1 : 0;
  }
}

// All columns of a sheet. `labels` numbers the rows of the given index sets, `inputs` has the given columns in
// SI as arrays (of one number for a scalar); NaN is a missing datum, and so is what its column does not allow.
function evaluateSheet(program, labels, inputs) {
  const data = { ...program.constants, ...inputs };
  for (const { name, allows } of program.columns) {
    if (allows) data[name] = data[name].map((x) => (isFinite(x) && allows(x) ? x : NaN));
  }
  const sheet = { layouts: {}, value: {}, status: {}, roots: {}, counted: {}, broken: {}, kept: {} };
  const { layouts, value, status } = sheet, faulty = {};
  for (const axis of program.axes) layouts[axis.name] = layOut(axis, layouts, labels, data);
  // One column, by its kernels or those of its start: its values and codes.
  const compute = ({ name, kind, axis, refs, sums, ...column }, what = "kernels") => {
    const size = axis === null ? 1 : layouts[axis].size;
    const out = new Float64Array(size), codes = new Uint8Array(size);
    const note = (list, row, what) => ((sheet[list][name] ??= {})[row] = what);
    for (const list of ["counted", "broken", "roots"]) delete sheet[list][name]; // of the pass before, in a loop
    if (kind === "given") {
      faulty[name] = fill(out, codes, (row) => data[name][row], 0, () => STATUS.INPUT);
      return [out, codes];
    }
    // Only what names a cell in error, or sums over no rows, can inherit an error.
    const doubtful = refs.filter(([other, , over]) => faulty[other] || (over !== null && layouts[over].size === 0));
    const keep = {}, sizes = {};
    for (const other in layouts) sizes[other] = layouts[other].size;
    for (const summed of sums) {
      keep[summed] = new Uint8Array(sizes[summed]).fill(1);
      const lost = leaveOut(keep[summed], doubtful, summed, layouts, status);
      if (lost) note("counted", summed, (sizes[summed] -= lost));
    }
    for (let row = 0; doubtful.length && row < size; row++) codes[row] = inherited(doubtful, axis, row, layouts, status, sizes, keep);
    if (what === "errors") {
      faulty[name] = codes.some(Boolean);
      return [[], codes];
    }
    const kernels = column[what](value, layouts, sizes, keep), { requires } = kernels, { positive } = column, unknown = [];
    sheet.kept[name] = { sizes, keep, unknown };
    kernels.seen = ((program.seen ??= {})[name] ??= []);
    for (let row = 0; requires && row < size; row++) {
      // What breaks a condition is outside the domain, whatever the rule would make of it.
      const failed = codes[row] ? 0 : requires(row).indexOf(false) + 1;
      if (!failed) continue;
      codes[row] = STATUS.DOMAIN;
      note("broken", row, failed);
    }
    const only = (row) => {
      const found = solveRoot(kernels, row);
      unknown[row] = kernels.unknown;
      if (found?.length === 0) codes[row] = STATUS.NOROOT;
      if (found?.length > 1) {
        const doubt = found[0] === null;
        codes[row] = doubt ? STATUS.UNDECIDED : STATUS.TWOROOTS;
        note("roots", row, found.slice(+doubt).sort((a, b) => a - b));
      }
      return found?.length === 1 ? found[0] : NaN;
    };
    // Where there is a value all the same, no double holds it, or a step towards it: 0 is one that was positive.
    const defined = kind === "root" ? (row, number) => !Number.isNaN(number) : kernels.defined ?? (() => true);
    const fault = (row, number) => {
      const beyond = number === 0 ? positive > 1 || kernels.positive?.(row) : number > 0 || Number.isNaN(number) || !positive;
      return beyond && defined(row, number) ? STATUS.OVERFLOW : STATUS.DOMAIN;
    };
    faulty[name] = fill(out, codes, kind === "root" ? only : kernels.value, positive, fault);
    return [out, codes];
  };
  const put = ({ name }, [out, codes]) => {
    value[name] = out;
    status[name] = codes;
  };
  program.columns.forEach((column, n, every) => {
    if (!column.loop) put(column, compute(column));
    else if (column.loop !== every[n - 1]?.loop) program.settle(every.filter(({ loop }) => loop === column.loop), compute, put, sheet, faulty, program.begun ?? {});
  });
  return sheet;
}

// Computes the rows that have no error yet; what no cell can hold gets a code. Says whether there is any error.
function fill(out, codes, compute, positive, fault) {
  let faulty = false;
  for (let row = 0; row < out.length; row++) {
    const number = codes[row] ? NaN : compute(row);
    if (isFinite(number) && (number >= SMALLEST || !positive)) out[row] = number;
    else {
      out[row] = NaN;
      codes[row] ||= fault(row, number);
      faulty = true;
    }
  }
  return faulty;
}

// Leaves out of a sum the rows where a cell has no value: one that has none must not take the sum with it.
function leaveOut(keep, doubtful, axis, layouts, status) {
  let lost = 0;
  for (const [name, index, over] of doubtful) {
    if (over !== axis) continue;
    const codes = status[name], rows = index === null ? null : layouts[axis].rows[index];
    for (let row = 0; row < keep.length; row++) {
      if (!keep[row] || codes[rows === null ? 0 : rows[row]] === STATUS.OK) continue;
      keep[row] = 0;
      lost++;
    }
  }
  return lost;
}

// Where the rows that a sum runs over begin and end: all of them, or those of a group.
function summed({ starts, size }, row) {
  return starts ? starts.slice(row, row + 2) : [0, size];
}

// The first error among the precedents; a sum has one only if none of its rows has a value.
function inherited(doubtful, axis, row, layouts, status, sizes, keep) {
  for (const [name, index, over] of doubtful) {
    const own = over === null, codes = status[name], [first, end] = own ? [row] : summed(layouts[over], row);
    if (!own && sizes[over] > 0 && keep[over].subarray(first, end).some(Boolean)) continue;
    const place = index === null ? 0 : layouts[over ?? axis].rows[index][first];
    const code = own || layouts[over].size > 0 ? codes[place] : STATUS.DOMAIN;
    if (code !== STATUS.OK) return code;
  }
  return STATUS.OK;
}
