// What a sheet gives when its inputs are drawn from their distributions (JCGM 101). A worker runs the program, this file
// and the two behind it, which know nothing of the page.

// Numbers between 0 and 1, the same ones every time (Doty-Humphrey's sfc32, of PractRand).
function generator() {
  let a = 1, b = 2, c = 3, counter = 1;
  const next = () => {
    const found = (a + b + counter++) | 0;
    a = b ^ (b >>> 9);
    b = (c + (c << 3)) | 0;
    c = ((c << 21 | c >>> 11) + found) | 0;
    return ((found >>> 0) + 0.5) / 2 ** 32;
  };
  for (let n = 0; n < 16; n++) next();
  return next;
}

const mixedIn = (pairs) => [...new Set(pairs.flatMap(([a, b]) => [a, b]))].sort((a, b) => a - b);

// A root of the correlations of some errors, as the rows of Cholesky's factor; nothing where nothing is left.
function rootOf(mixed, pairs) {
  const between = (a, b) => (a === b ? 1 : pairs.reduce((all, [one, other, r]) => ((one === a && other === b) || (one === b && other === a) ? r : all), 0));
  const rows = [];
  mixed.forEach((n, i) => {
    const row = (rows[i] = []);
    for (let j = 0; j <= i; j++) {
      const rest = between(n, mixed[j]) - rows[j].slice(0, j).reduce((all, one, k) => all + one * row[k], 0), own = rows[j][j];
      row[j] = i === j ? Math.sqrt(Math.max(0, rest)) : own > 1e-7 ? rest / own : 0;
    }
  });
  return rows;
}

// What gives all errors once more, each in units of its standard uncertainty. Those that are correlated are normal; those
// of one sample are together as wrong as their common estimate is (JCGM 101, 6.4.9).
function drawer(errors, pairs) {
  const next = generator(), wave = (turn) => Math.sin(2 * Math.PI * turn);
  const normal = () => Math.sqrt(-2 * Math.log(next())) * wave(next());
  // Half of a chi-square with so many halves of a degree of freedom (Marsaglia and Tsang, for one more, taken back).
  const gamma = (size) => {
    const d = size + 2 / 3, c = 1 / Math.sqrt(9 * d);
    for (;;) {
      const x = normal(), v = (1 + c * x) ** 3;
      if (v > 0 && Math.log(next()) < x * x / 2 + d * (1 - v + Math.log(v))) return d * v * next() ** (1 / size);
    }
  };
  const shapes = {
    normal, rectangular: () => Math.sqrt(3) * (2 * next() - 1), triangular: () => Math.sqrt(6) * (next() - next()), arcsine: () => Math.SQRT2 * wave(next()),
  };
  const mixed = mixedIn(pairs), root = rootOf(mixed, pairs);
  const shared = ({ sample }) => sample && errors.filter((other) => other.sample === sample).length > 1;
  const places = errors.map((_, n) => mixed.indexOf(n)), wide = errors.map((error, n) => error.dof && (shared(error) || places[n] < 0));
  return () => {
    const scales = {}, own = mixed.map(normal);
    return errors.map(({ shape, dof, sample }, n) => {
      const error = places[n] < 0 ? (shapes[shape] ?? normal)() : root[places[n]].reduce((all, one, k) => all + one * own[k], 0);
      return wide[n] ? error * (scales[sample ?? n] ??= Math.sqrt(dof / 2 / gamma(dof / 2))) : error;
    });
  };
}

// The columns whose sums run over other rows than elsewhere: what rests on them is a value of another estimator.
function otherRows(here, there) {
  const moved = (name) => Object.entries(here[name].keep).some(([axis, rows]) => rows.some((kept, row) => kept !== there[name].keep[axis][row]));
  return Object.keys(here).filter(moved);
}

// What was given, with errors that are so many standard uncertainties.
function displaced(data, errors, by) {
  const inputs = { ...data };
  errors.forEach(({ moves }, which) => {
    for (const [name, row, u] of by[which] ? moves : []) {
      if (inputs[name] === data[name]) inputs[name] = data[name].slice();
      inputs[name][row] += u * by[which];
    }
  });
  return inputs;
}

// The program of some cells alone, by the columns that they rest on.
function within(names) {
  const asked = new Set(names.flat());
  return { ...PROGRAM, columns: PROGRAM.columns.filter(({ name }) => asked.has(name)) };
}

// The same with its fits begun at what they came to: draws lie about it, their author's start may be far away.
function begunAt(program, { value, status }) {
  const fitted = program.columns.filter(({ name, axis, start }) => start && axis === null && !status[name][0]);
  return { ...program, begun: Object.fromEntries(fitted.map(({ name }) => [name, value[name][0]])) };
}

// The values of some cells, sorted, of as many draws as asked for: those that have one over the rows of the estimate.
// `data` and `labels` are the sheet's; `names` has for each cell the columns that it rests on, and its own.
function drawn({ count, labels, data, errors, pairs, cells, names }) {
  const asked = within(names), draw = drawer(errors, pairs), found = cells.map(() => []), here = evaluateSheet(asked, labels, data), program = begunAt(asked, here);
  for (let n = 0; n < count; n++) {
    const { value, status, kept } = evaluateSheet(program, labels, displaced(data, errors, draw())), others = otherRows(kept, here.kept);
    cells.forEach(([name, row], which) => {
      if (!status[name][row] && !others.some((other) => names[which].includes(other))) found[which].push(value[name][row]);
    });
  }
  return found.map((values) => new Float64Array(values).sort());
}
