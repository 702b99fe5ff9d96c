// Intervals, rounded outwards: each holds what an operation gives for any numbers in its arguments. Of the elementary
// functions 4 units in the last place are allowed for. Most of an edit is spent here, so that an interval is no object but
// two numbers, one behind the other: a function gives the lower end, and leaves the upper one in `up[0]`.
// A program brings what it calls of these, part by part: a blank line is between two of them.

const up = new Float64Array(1);

const ALL = [-Infinity, Infinity];

const side = (low, high) => (low > 0 ? 1 : high < 0 ? -1 : 0);

function out(low, high, places = 1) {
  const by = places * Number.EPSILON, least = Number.MIN_VALUE;
  low -= Math.abs(low) * by + least;
  high += Math.abs(high) * by + least;
  const known = low <= high; // no number means that nothing is known
  up[0] = known ? high : Infinity;
  return known ? low : -Infinity;
}

const plus = (a, b, c, d) => out(a + c, b + d);

function times(a, b, c, d) {
  const p = a * c, q = a * d, r = b * c, s = b * d;
  let low = p, high = p; // 0 times infinity is no number: another one of these tells, or nothing is known
  if (q < low) low = q;
  else if (q > high) high = q;
  if (r < low) low = r;
  else if (r > high) high = r;
  if (s < low) low = s;
  else if (s > high) high = s;
  return out(low, high);
}

function power(a, b, n) {
  const m = Math.abs(n), p = a ** m, q = b ** m;
  let c = out(Math.min(p, q), Math.max(p, q), 4);
  if (a >= 0 || !(n % 2)) c = a < 0 && b > 0 ? 0 : Math.max(c, 0); // rounding outwards takes none of these below zero
  if (n > 0) return c;
  const d = up[0];
  return c > 0 || d < 0 ? out(1 / d, 1 / c) : c === 0 ? out(1 / d, Infinity) : out(-Infinity, Infinity);
}

const rising = (f, a, b) => out(f(a), f(b), 4);

function cosine(a, b) {
  const first = Math.ceil(a / Math.PI - 1e-9), last = Math.floor(b / Math.PI + 1e-9);
  const known = last - first < 1 && Math.abs(a) + Math.abs(b) < 1e6;
  const c = Math.cos(a), d = Math.cos(b), turn = known && first === last && 1 - 2 * Math.abs(first % 2);
  up[0] = turn === 1 || !known ? 1 : Math.max(c, d) + 4 * Number.EPSILON;
  return turn === -1 || !known ? -1 : Math.min(c, d) - 4 * Number.EPSILON;
}

// Of several terms over the rows that are kept, which `terms` writes down. All additions together lose no more than each
// a half unit of the last place of the sum of what is added, whatever its signs.
function sums(kept, count, terms) {
  const own = new Float64Array(2 * count), all = new Float64Array(2 * count), size = new Float64Array(count);
  let rows = 0;
  for (let row = 0; row < kept.length; row++) {
    if (!kept[row]) continue;
    terms(row, own);
    for (let n = 0; n < count; n++) {
      const a = own[2 * n], b = own[2 * n + 1];
      all[2 * n] += a;
      all[2 * n + 1] += b;
      size[n] += Math.max(-a, b);
    }
    rows++;
  }
  for (let n = 0; n < count; n++) {
    const lost = rows * Number.EPSILON * size[n];
    all[2 * n] = out(all[2 * n] - lost, all[2 * n + 1] + lost);
    all[2 * n + 1] = up[0];
  }
  return all;
}

// The roots of a form in an interval, each between two points where its sign is certain. A part is settled where
// the form is certainly not zero, or its slope is not; any other is halved. First null where that fails, then the place.
// The parts of a program's first sheet are kept in `seen`: mostly they are settled in its others, too.
function isolate(root, row, low, high, told) {
  const look = (a, b) => {
    const [f, g, s, t] = root.enclose(row, a, b);
    if (side(f, g) || side(s, t)) return [side(f, g), side(s, t)];
    const mid = (a + b) / 2, [c, d] = root.enclose(row, mid, mid);
    return [side(plus(c, d, times(s, t, plus(a, b, -mid, -mid), up[0]), up[0]), up[0]), 0];
  };
  const parts = [], found = [], signAt = (end, at, part) => part?.[2] || look(end, end)[0] || Math.sign(told[at]);
  let left = 2000, place = low, way = 0;
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
  let was = signAt(low, 0, parts[0]);
  for (const [a, b, s, slope] of [...parts, [high, high, signAt(high, 1, parts.at(-1)), 0]]) {
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
