// Intervals [low, high], rounded outwards: each holds what an operation gives for any numbers in its arguments,
// of which one may be a plain number. Of the elementary functions 4 units in the last place are allowed for.
// A program brings what it calls of these, part by part: a blank line is between two of them.

const ALL = [-Infinity, Infinity];

const span = (x) => (x.length ? x : [x, x]);

function side(x) {
  const [low, high] = span(x);
  return low > 0 ? 1 : high < 0 ? -1 : 0;
}

function out(low, high, by = Number.EPSILON) {
  low -= Math.abs(low) * by + Number.MIN_VALUE;
  high += Math.abs(high) * by + Number.MIN_VALUE;
  return low <= high ? [low, high] : [-Infinity, Infinity]; // no number means that nothing is known
}

function plus(x, y) {
  let a = x, b = x, c = y, d = y;
  if (x.length) a = x[0], b = x[1];
  if (y.length) c = y[0], d = y[1];
  return out(a + c, b + d);
}

function times(x, y) {
  let a = x, b = x, c = y, d = y;
  if (x.length) a = x[0], b = x[1]; // no arrays taken apart: most of an edit is spent here
  if (y.length) c = y[0], d = y[1];
  const p = a * c || 0, q = a * d || 0, r = b * c || 0, s = b * d || 0;
  return out(Math.min(p, q, r, s), Math.max(p, q, r, s));
}

function power(x, n) {
  const [a, b] = span(x), p = a ** Math.abs(n), q = b ** Math.abs(n);
  let [c, d] = n % 2 || a > 0 || b < 0 ? out(Math.min(p, q), Math.max(p, q), 4 * Number.EPSILON) : [0, out(p, Math.max(p, q), 4 * Number.EPSILON)[1]];
  if (a >= 0) c = Math.max(c, 0); // rounding outwards takes no power of a positive number below zero
  if (n > 0) return [c, d];
  return c > 0 || d < 0 ? out(1 / d, 1 / c) : c === 0 ? out(1 / d, Infinity) : ALL;
}

function rising(f, x) {
  return x.length ? out(f(x[0]), f(x[1]), 4 * Number.EPSILON) : out(f(x), f(x), 4 * Number.EPSILON);
}

function cosine(x) {
  const [a, b] = span(x), first = Math.ceil(a / Math.PI - 1e-9), last = Math.floor(b / Math.PI + 1e-9);
  if (!(last - first < 1 && Math.abs(a) + Math.abs(b) < 1e6)) return [-1, 1];
  const [c, d] = [Math.cos(a), Math.cos(b)], turn = first === last && 1 - 2 * Math.abs(first % 2);
  return [turn === -1 ? -1 : Math.min(c, d) - 4 * Number.EPSILON, turn === 1 ? 1 : Math.max(c, d) + 4 * Number.EPSILON];
}

// Of several terms over the rows that are kept. All additions together lose no more than each a half unit of the last
// place of the sum of what is added, whatever its signs.
function sums(kept, terms) {
  const low = [], high = [], size = [];
  let count = 0;
  for (let row = 0; row < kept.length; row++) {
    if (!kept[row]) continue;
    const found = terms(row);
    for (let n = 0; n < found.length; n++) {
      let a = found[n], b = a;
      if (a.length) b = a[1], a = a[0];
      if (count) low[n] += a, high[n] += b, size[n] += Math.max(-a, b);
      else low[n] = a, high[n] = b, size[n] = Math.max(-a, b);
    }
    count += 1;
  }
  return low.map((_, n) => {
    const lost = count * Number.EPSILON * size[n];
    return out(low[n] - lost, high[n] + lost);
  });
}

// The roots of a form in an interval, each between two points where its sign is certain. A part is settled where
// the form is certainly not zero, or its slope is not; any other is halved. First null where that fails, then the place.
// The parts of a program's first sheet are kept in `seen`: mostly they are settled in its others, too.
function isolate(root, row, low, high, told) {
  const look = (a, b) => {
    const [f, slope] = root.enclose(row, [a, b]);
    if (side(f) || side(slope)) return [side(f), side(slope)];
    const mid = (a + b) / 2, [g] = root.enclose(row, [mid, mid]);
    return [side(plus(g, times(slope, plus([a, b], -mid)))), 0];
  };
  const parts = [], found = [];
  let left = 2000, place = low, way = 0, [was, last] = [low, high].map((end, at) => look(end, end)[0] || Math.sign(told[at]));
  const cut = (a, b, n) => {
    const [f, slope] = look(a, b), mid = (a + b) / 2;
    if (f || slope || !n || --left < 0) parts.push([a, b, f, slope]);
    else {
      cut(a, mid, n - 1);
      cut(mid, b, n - 1);
    }
  };
  const kept = root.seen[row], ends = kept?.[0] === low && kept.at(-1) === high ? kept : [low, high];
  if (low < high) for (let n = 1; n < ends.length; n++) cut(ends[n - 1], ends[n], 48);
  root.seen[row] ??= [low, ...parts.map(([, b]) => b)];
  for (const [a, b, s, slope] of [...parts, [high, high, last, 0]]) {
    if (!s && slope && way * slope >= 0) {
      way = slope;
      continue;
    }
    if (!s && a < b) return [null, a, b];
    if (a > place ? !(was * s) : was * s < 0) return [null, place, a];
    if (was * s < 0) found.push([place, a, s]);
    [place, was, way] = [b, s, 0];
  }
  return found;
}
