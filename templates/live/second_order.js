// What second derivatives add to the variances of cells (JCGM 100, 5.1.2, note), as a rebuild tells it
// (uncertainty/second_order.py, which says why): how slopes change a little to either side. It runs in the worker.

const STEP = 1 / 16, FAR = 2; // in standard uncertainties: to slopes beside, and about as far as U reaches
const COUNTS = 0.05; // of the variance of first order
const ROUNDING = 2 ** -40; // of a value
const SHARP = 16; // of what a cell is off far away: what its bend here would make of it
const FOURTH = { rectangular: 9 / 5, triangular: 12 / 5, arcsine: 3 / 2 }; // moments, over the square of the variance

// Independent errors of which the others are made: each as what it does to all of them.
function independent(errors, pairs) {
  const mixed = mixedIn(pairs), root = rootOf(mixed, pairs);
  return errors.map(({ shape }, n) => {
    const place = mixed.indexOf(n), by = errors.map((_, other) => (place < 0 ? Number(other === n) : root[mixed.indexOf(other)]?.[place] ?? 0));
    return { by, fourth: place < 0 ? FOURTH[shape] ?? 3 : 3 };
  });
}

// For each cell, in the square of its unit in SI: 0 where it does not count, NaN where nobody knows, and infinite where
// first order tells nothing, either. `rough` has for each whether it rests on a function with corners (1; -1 of what
// cannot be negative, which has one at 0) or on what is taken by order (2).
function secondOrder({ labels, data, errors, pairs, cells, names, rough }) {
  const alone = within(names), here = evaluateSheet(alone, labels, data), program = begunAt(alone, here);
  const reach = errors.map(({ moves }) => ({ moves: moves.filter(([name]) => program.columns.some((one) => one.name === name)) }));
  const ways = independent(errors, pairs), along = (way, far) => evaluateSheet(program, labels, displaced(data, errors, way.by.map((one) => far * one)));
  // The slopes of the cells along every way; nothing of a cell without a value.
  const slopes = (sheet) => {
    const effects = sensitivities(program.columns, sheet, reach);
    return cells.map(([name, row]) => ways.map(({ by }) => (sheet.status[name][row] ? NaN : by.reduce((all, one, n) => all + (one && one * (effects[name]?.[row * by.length + n] ?? 0)), 0))));
  };
  const first = slopes(here), torn = new Set(), value = (sheet, [name, row]) => (sheet.status[name][row] ? NaN : sheet.value[name][row]);
  const beside = ways.map((way) => [1, -1].map((side) => {
    const near = along(way, side * STEP), far = along(way, side * FAR);
    otherRows(near.kept, here.kept).forEach((name) => torn.add(name));
    return { slopes: slopes(near), far: cells.map((cell) => value(far, cell)) };
  }));
  return cells.map((cell, c) => {
    const sides = beside.map((both) => both.map((one) => ({ slopes: one.slopes[c], far: one.far[c] }))), now = value(here, cell);
    return counted(termsOf(ways, first[c], sides, now), now, rough[c], names[c].some((name) => torn.has(name)));
  });
}

// The parts of the variance of a cell, of its slopes along every way, and of slopes and values to either side (`beside`): of
// first order (`own`), of squared second derivatives (`bent`; those along one way `alone`), of third derivatives times
// slopes (`turned`), and by how much the cell is off its tangent far away (`off`).
function termsOf(ways, first, beside, now) {
  let own = 0, bent = 0, turned = 0, off = 0, alone = 0;
  const third = (j, i) => (beside[j][0].slopes[i] - 2 * first[i] + beside[j][1].slopes[i]) / STEP ** 2;
  // A slope is known to the square of the step that it is asked by.
  const slope = first.map((one, i) => (Math.abs(one) > MOVE ** 2 * Math.abs(third(i, i)) ? one : 0));
  beside.forEach(([up, down], j) => {
    own += slope[j] ** 2;
    const away = [(up.far - now - FAR * slope[j]) ** 2, (down.far - now + FAR * slope[j]) ** 2];
    for (const one of away) off += one || 0;
    ways.forEach(({ fourth }, i) => {
      const second = (up.slopes[i] - down.slopes[i]) / (2 * STEP);
      bent += second ** 2 * (i === j ? (fourth - 1) / 4 : 1 / 2);
      turned += slope[i] * third(j, i) * (i === j ? fourth / 3 : 1);
      if (i === j && away[0] + away[1] >= 0) alone += second ** 2 / 2;
    });
  });
  return { own, bent, turned, off, alone };
}

// What of these terms counts for a cell whose value is `now`; `torn`: its sums run over other rows beside.
function counted({ own, bent, turned, off, alone }, now, rough, torn) {
  const more = bent + turned, least = COUNTS * own, rounding = (ROUNDING * now) ** 2, nothing = own <= rounding;
  if (nothing && more <= rounding) return off > rounding ? Infinity : 0; // of third order, or more
  const little = Math.max(bent, Math.abs(more)) <= least;
  if (rough > 1 || (rough && !little) || (rough < 0 && FAR * Math.sqrt(own) > now) || torn) return NaN;
  if (!nothing && (more < -own / 2 || (little && off / FAR ** 4 > least))) return NaN;
  if (alone > COUNTS * (own + bent) && alone > SHARP * off / FAR ** 4) return own ? NaN : Infinity; // slopes change here at once, and no further
  return little ? 0 : own + more > 0 ? more : bent;
}

if (!self.document) self.onmessage = ({ data: { looked, ...asked } }) => {
  if (looked?.cells.length) postMessage({ more: secondOrder({ ...asked, ...looked }) });
  postMessage({ found: drawn(asked) });
};
