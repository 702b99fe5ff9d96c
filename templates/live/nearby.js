// A sheet near to where it was computed: what its cells do when something that was given moves.
// Nothing in this file knows the page.

const NEAR = 2 ** -17; // of a root: so far from it its form is asked for its slope
const MOST_PASSES = 60; // of columns that rest on one another

// The values of all columns where given cells are moved, each as [column, row, by how much]. Only what rests on them
// is computed. Every cell keeps its status; a root goes one step from where it was, which is right to first order.
function nearby(columns, sheet, moves) {
  const { layouts, kept, status } = sheet, value = { ...sheet.value }, moved = {};
  for (const [name, row, by] of moves) {
    if (!moved[name]) [value[name], moved[name]] = [value[name].slice(), []];
    value[name][row] += by;
    moved[name][row] = true;
  }
  const again = (column) => {
    const { name, axis, kind, refs } = column, touched = refs.filter(([other]) => moved[other]);
    if (kind === "given" || !touched.length) return [value[name], moved[name]];
    const whole = touched.some(([, index, over]) => index === null || over !== null), own = [];
    const ways = whole ? [] : touched.map(([other, index]) => [moved[other], layouts[axis].rows[index]]);
    const { sizes, keep, unknown } = kept[name] ?? {}, out = sheet.value[name].slice();
    const kernels = kept[name] && column.kernels(value, layouts, sizes, keep);
    for (let row = 0; row < out.length; row++) {
      if (status[name][row] || !(whole || ways.some(([those, rows]) => those[rows[row]]))) continue;
      own[row] = true;
      const u = kind === "root" && unknown[row];
      out[row] = kernels.value(row, kind === "root" ? u - kernels.at(row, u) / slopes(sheet, column)[row] : undefined);
    }
    return [out, own];
  };
  const put = ({ name }, found) => ([value[name], moved[name]] = found);
  columns.forEach((column, n) => {
    if (!column.loop) put(column, again(column));
    else if (column.loop !== columns[n - 1]?.loop) settleNearby(columns.filter(({ loop }) => loop === column.loop), again, put, value);
  });
  return value;
}

// Passes until nothing moves that rounding does not move, from where the loop was.
function settleNearby(loop, again, put, value) {
  const iterated = loop.filter(({ start }) => start), formulas = loop.filter(({ start }) => !start);
  const pass = () => formulas.forEach((column) => put(column, again(column)));
  for (let passes = 0, far = Infinity; far > 2 ** -50 && passes < MOST_PASSES; passes++) {
    pass();
    const after = iterated.map(again);
    far = 0;
    iterated.forEach((column, n) => {
      after[n][0].forEach((now, row) => (far = Math.max(far, Math.abs((now - value[column.name][row]) / now) || 0)));
      put(column, after[n]);
    });
  }
  pass();
}

// How fast the form of each root changes with what is sought.
function slopes({ value, layouts, kept }, { name, kernels }) {
  const { sizes, keep, unknown, found = [] } = kept[name];
  if (!found.length) {
    const { at } = kernels(value, layouts, sizes, keep);
    unknown.forEach((u, row) => {
      const far = NEAR * Math.abs(u);
      found[row] = (at(row, u + far) - at(row, u - far)) / (2 * far);
    });
    kept[name].found = found;
  }
  return found;
}
