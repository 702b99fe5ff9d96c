// How sure the cells are: the errors of what was given, and what they do to each cell, by the law of propagation of
// uncertainty (JCGM 100, 5.1 and 5.2), to first order.

const MOVE = 2 ** -11; // in standard uncertainties, to both sides: far enough for doubles, near enough for a straight line
const CELLS = PROGRAM.columns.filter(({ name }) => LIVE.columns[name]);

// Every independent error of a state: what it is called, and what it moves, by one standard uncertainty.
function* errorsIn(look) {
  for (const { name, axis } of CELLS) {
    const column = LIVE.columns[name], texts = column.given && !column.given.bounds.integer ? look.texts(name) : [];
    for (const [row, text] of texts.entries()) {
      const index = look.trace.index(name, row), own = errorsOf(column, index, text), called = look.trace.address(name, row);
      for (const error of own) yield { ...error, called: own.length > 1 ? `${called}, ${error.said}` : called, moves: [[name, row, error.u]] };
    }
  }
  for (const { called, of, groups, ...error } of LIVE.shared) {
    const column = LIVE.columns[of], texts = look.texts(of), every = texts.map((_, row) => look.trace.index(of, row));
    for (const group of groups ?? [every]) {
      const rows = group.map((label) => every.indexOf(String(label))).filter((row) => row >= 0);
      const found = rows.map((row) => errorsOf({ ...column, errors: [error] }, "", texts[row])[0]);
      const moves = rows.flatMap((row, n) => (found[n] ? [[of, row, found[n].u]] : []));
      const named = groups ? ` (${group.length > 1 ? ROWS : ROW} ${group.join(", ")})` : "";
      if (moves.length) yield { ...error, called: called + named, moves };
    }
  }
}

// What is known of the uncertainty of a sheet's cells, computed when asked for.
class Sure {
  constructor(look) {
    this.trace = look.trace;
    this.errors = [...errorsIn(look)];
    const place = (called) => this.errors.findIndex((error) => error.called === called);
    this.pairs = LIVE.correlated.flatMap(([one, other, r]) => {
      const rows = [...this.trace.sheet.value[one].keys()].map((row) => [one, other].map((name) => place(this.trace.address(name, row))));
      return rows.filter((both) => !both.includes(-1)).map((both) => [...both, r]);
    });
    [this.known, this.told] = [{}, {}];
  }

  // The sheet to both sides of where it is, along each error, and how far apart they are in its standard uncertainty.
  get sides() {
    const { sheet } = this.trace;
    return (this.found ??= this.errors.map(({ moves }) => {
      const [up, down] = [MOVE, -MOVE].map((far) => nearby(CELLS, sheet, moves.map(([name, row, u]) => [name, row, far * u])));
      const [name, row, u] = moves[0];
      return { up, down, apart: (up[name][row] - down[name][row]) / u };
    }));
  }

  // What each error does to a cell, in SI, with its sign.
  parts(name, row) {
    return this.sides.map(({ up, down, apart }) => (up[name] === down[name] ? 0 : (up[name][row] - down[name][row]) / apart));
  }

  // Each of them times what it makes of the variance, together with those that it is correlated with.
  variances(parts) {
    const found = parts.map((part) => part * part);
    for (const [a, b, r] of this.pairs) {
      found[a] += r * parts[a] * parts[b];
      found[b] += r * parts[a] * parts[b];
    }
    return found;
  }

  // The combined standard uncertainty of a cell; NaN where nothing is known of it.
  u(name, row) {
    const { axis } = this.trace.declared[name];
    if (axis !== null && axisNamed(axis).kind === "repeat" || !this.trace.isOk(name, row)) return NaN;
    return ((this.known[name] ??= [])[row] ??= Math.sqrt(Math.max(0, sum(this.variances(this.parts(name, row))))));
  }

  // Where the uncertainty of a cell comes from, the largest first, and its coverage factor.
  budget(name, row) {
    return ((this.told[name] ??= [])[row] ??= this.sources(name, row));
  }

  sources(name, row) {
    const parts = this.parts(name, row), u = this.u(name, row), variances = this.variances(parts), least = 1e-12 * Math.max(...parts.map(Math.abs));
    const from = this.errors.map((error, n) => ({ ...error, part: parts[n], share: variances[n] / u ** 2 }));
    const factor = this.factor(parts, variances, this.freedom(parts, variances, u), u);
    return { u, factor, from: from.filter(({ part }) => Math.abs(part) > least).sort((a, b) => Math.abs(b.share) - Math.abs(a.share)) };
  }

  // Effective degrees of freedom (JCGM 100, G.2b): errors of one sample are one estimate. NaN if correlated ones have any.
  freedom(parts, variances, u) {
    const samples = this.errors.map(({ sample }, n) => sample ?? n), found = new Map();
    const apart = this.pairs.filter(([a, b]) => parts[a] && parts[b] && samples[a] !== samples[b]);
    if (apart.some(([a, b]) => this.errors[a].dof || this.errors[b].dof)) return NaN;
    variances.forEach((one, n) => found.set(samples[n], (found.get(samples[n]) ?? 0) + one));
    const below = sum(this.errors.map(({ dof }, n) => {
      const own = found.get(samples[n]);
      found.delete(samples[n]);
      return dof && own > 0 ? (own / u ** 2) ** 2 / dof : 0;
    }));
    return below ? Math.max(1, Math.floor(Math.round(100 / below) / 100)) : Infinity;
  }

  // From the sum of the errors, where they are not all normal or t; as a rebuild tells it (uncertainty/convolution.py).
  factor(parts, variances, freedom, u) {
    const { errors, pairs } = this, mixed = new Set(pairs.flatMap(([a, b]) => [a, b])), found = new Map();
    const moving = [...parts.keys()].filter((n) => parts[n]), ended = (n) => !mixed.has(n) && ENDED[errors[n].shape];
    if (!freedom || !moving.some(ended) || moving.some((n) => errors[n].dof && errors[n].shape !== "t")) return studentFactor(freedom);
    for (const n of moving) {
      const { shape, dof, sample } = errors[n], own = ended(n) || (dof && (sample || !mixed.has(n)));
      const key = !own ? "normal" : dof && sample ? sample : n, one = found.get(key) ?? { shape: own ? shape : "normal", dof, variance: 0 };
      found.set(key, { ...one, variance: one.variance + variances[n] / u ** 2 });
    }
    return summedFactor([...found.values()].map((one) => ({ ...one, size: Math.sqrt(Math.max(0, one.variance)) })));
  }
}

const NORMAL = 1.959963984540054;
// Of errors that end: where, in standard uncertainties, and the share within a part of that.
const ENDED = {
  rectangular: [Math.sqrt(3), (x) => x], triangular: [Math.sqrt(6), (x) => 1 - (1 - x) ** 2], arcsine: [Math.SQRT2, (x) => 2 / Math.PI * Math.asin(x)],
};
const HALF = 4000; // points of a distribution on either side

// Half of what holds 95 % of a sum of independent errors, in standard uncertainties. The distribution of the first, normal or
// the largest that ends, is spread by one error after the other: evenly over a width, or over points that have weights.
function summedFactor(errors) {
  const order = ({ shape, dof, size }) => (ENDED[shape] ? 1 - size / 8 : dof ? 2 + 1 / dof : 0), [first, ...others] = errors.sort((a, b) => order(a) - order(b));
  const ends = ({ shape, dof, size }) => size * (ENDED[shape]?.[0] ?? (dof ? 2 * studentFactor(dof) : 6)), heaviest = errors.at(-1).dof ?? Infinity;
  const reach = sum(errors.map(ends)), step = reach / HALF, places = Array.from({ length: 2 * HALF + 1 }, (_, n) => (n - HALF) * step);
  const share = ENDED[first.shape]?.[1] ?? ((x) => 2 * bell(6 * x));
  let below = places.map((x) => (1 + Math.sign(x) * share(Math.min(1, Math.abs(x) / ends(first)))) / 2);
  // Between the points in proportion; beyond them what is left falls as the tails of a t distribution do.
  const at = (values, x, beyond) => {
    const n = (Math.abs(x) + reach) / step, low = Math.floor(n);
    if (n >= 2 * HALF) return beyond(x);
    return x < 0 ? 1 - at(values, -x, beyond) : values[low] + (n - low) * (values[low + 1] - values[low]);
  };
  const evenly = (half) => {
    const whole = new Float64Array(2 * HALF + 1), own = new Float64Array(2 * HALF + 1), far = half / step;
    for (let n = 1; n <= 2 * HALF; n++) whole[n] = whole[n - 1] + step * (below[n] + below[n - 1]) / 2;
    const upTo = (n) => { // the integral up to a place between the points
      if (n >= 2 * HALF) return whole[2 * HALF] + (n - 2 * HALF) * step;
      const low = Math.floor(n);
      return n < HALF ? (n <= 0 ? 0 : upTo(2 * HALF - n) + (n - HALF) * step) : whole[low] + (n - low) * (whole[low + 1] - whole[low]);
    };
    for (let n = HALF; n <= 2 * HALF; n++) own[2 * HALF - n] = 1 - (own[n] = (upTo(n + far) - upTo(n - far)) / (2 * half)); // turned around
    below = own;
  };
  const over = (points, weigh) => {
    const weights = points.map(weigh), all = sum(weights), own = below, left = 1 - own[2 * HALF];
    const beyond = (x) => (x < 0 ? left * (reach / -x) ** heaviest : 1 - left * (reach / x) ** heaviest);
    below = places.map((x) => sum(points.map((point, n) => weights[n] * at(own, x - point, beyond))) / all);
  };
  const turns = (number) => Array.from({ length: number }, (_, n) => ((n + 0.5) / number - 0.5) * Math.PI);
  for (const { shape, dof, size } of others.filter((one) => one.size > 0)) {
    if (shape === "rectangular") evenly(Math.sqrt(3) * size);
    else if (shape === "triangular") [1, 2].forEach(() => evenly(Math.sqrt(6) * size / 2));
    else if (shape === "arcsine") over(turns(100).map((turn) => Math.SQRT2 * size * Math.sin(turn)), () => 1);
    else over(turns(dof < 3 ? 2000 : 200).map((turn) => Math.sqrt(dof) * size * Math.tan(turn)), (t) => (1 + (t / size) ** 2 / dof) ** (-(dof - 1) / 2));
  }
  const within = (n) => below[HALF + n] - below[HALF - n];
  let n = 1;
  while (n < HALF && within(n) < 0.95) n++;
  return step * (n - (within(n) - 0.95) / (within(n) - within(n - 1)));
}

// The share of a normal distribution between 0 and z standard deviations, by Simpson's rule.
function bell(z) {
  const parts = 64, at = (n) => Math.exp(-((n * z / parts) ** 2) / 2) * (n % parts ? 2 + 2 * (n % 2) : 1);
  return z / parts / 3 / Math.sqrt(2 * Math.PI) * sum(Array.from({ length: parts + 1 }, (_, n) => at(n)));
}

// The same of a t distribution: with t = sqrt(freedom) tan(angle) it is an integral of a power of the cosine.
function studentFactor(freedom) {
  if (Number.isNaN(freedom)) return NaN;
  if (freedom > 1000) return NORMAL * (1 + (NORMAL ** 2 + 1) / (4 * freedom));
  const upTo = (angle) => {
    let n = (freedom - 1) % 2, all = n ? Math.sin(angle) : angle;
    for (n += 2; n < freedom; n += 2) all = (Math.cos(angle) ** (n - 1) * Math.sin(angle) + (n - 1) * all) / n;
    return all;
  };
  let low = 0, high = Math.PI / 2;
  for (const wanted = 0.95 * upTo(high); high - low > 1e-13; ) [low, high] = upTo((low + high) / 2) < wanted ? [(low + high) / 2, high] : [low, (low + high) / 2];
  return Math.sqrt(freedom) * Math.tan(low);
}

// --- told ------------------------------------------------------------------------------------------------

const percent = (share) => `${figureText(decimals(100 * share, 0))}\u00a0%`;

// Value, u, k and U of a cell, as texts, and its budget; nothing where there is none.
function sureOf(look, name, row) {
  const { scale, zero, kept } = LIVE.columns[name];
  const sure = LIVE.shared && !kept?.[look.trace.index(name, row)] ? look.sure.u(name, row) : 0;
  if (!(sure > 0 && sure < Infinity)) return null;
  const { u, factor, from } = look.sure.budget(name, row), value = (look.trace.sheet.value[name][row] - zero) / scale;
  const of = (width) => stated(value, width / scale, LIVE.most).map(figureText), known = factor > 0;
  return { texts: [...of(u), known ? figureText(rounded(factor, order(factor) - 2)) : "", known ? of(factor * u)[1] : ""], from };
}

// The results with their uncertainties, again: in their table, and where they stand first.
function writeUncertain(look) {
  for (const line of LIVE.shared ? all("#uncertain tbody tr") : []) {
    const [, name, index = ""] = ADDRESS.exec(line.cells[0].textContent), row = look.trace.row(name, index);
    const known = row >= 0 && sureOf(look, name, row), shown = row < 0 ? "–" : look.cell(name, row).text;
    const { texts, from } = known || { texts: [shown, "", "", ""], from: [] };
    texts.forEach((text, n) => setText(line.cells[n + 1], text));
    const most = from.slice(0, 3).filter(({ share }) => share >= 0.05);
    line.cells[6].replaceChildren(...most.flatMap(({ called, share }, n) => [n ? ", " : "", make("code", {}, called), `\u00a0${percent(share)}`]));
  }
  for (const told of all(".headline .sure")) {
    const name = told.parentElement.querySelector("[data-cell]").dataset.cell, known = LIVE.shared && sureOf(look, name, 0);
    const unit = LIVE.columns[name].unit === "1" ? [] : ["\u00a0", ...part(name, "unit")], [, , factor, wide] = known ? known.texts : [];
    told.replaceChildren(...(wide ? [`±\u00a0${wide}`, ...unit, ` (k\u00a0=\u00a0${factor})`] : []));
  }
}

const ADDRESS = /^(\w+)(?:\[(.*)\])?$/;
const sum = (numbers) => numbers.reduce((all, one) => all + one, 0);
const axisNamed = (name) => PROGRAM.axes.find((one) => one.name === name);
