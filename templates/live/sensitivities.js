// How cells move with errors: the sensitivity coefficients of a sheet where it is (JCGM 100, 5.1.3). Every formula is
// asked for its slope by each cell that it names, and the chain rule does the rest. Nothing in this file knows the page.

const MOVE = 2 ** -10; // in standard uncertainties, to both sides: far enough for doubles
const BENT = 2 ** -16; // of the change to both sides together: what those to either side may differ by; a middle is wrong by the square of it, less than LEFT
const LEAST = 2 ** -32; // of a cell: no step is shorter
const NEAR = 2 ** -17; // of a root: so far from it its form is asked for its slope
const LEFT = 2 ** -30; // of the steps of all ways to a cell: what is left of an effect where they cancel is rounding
const STILL = 2 ** -30; // of the largest effect: what moves no more is settled, as far as slopes are known
const MOST_PASSES = 60; // of columns that rest on one another

// For each column, in SI, what each of the errors does to each of its rows: row by row in one array. There is none where
// no error reaches the column. An error tells what it moves, as [column, row, by how much].
function sensitivities(columns, sheet, errors) {
  const found = {}, known = {}, count = errors.length, blank = (name) => new Float64Array(sheet.value[name].length * count);
  errors.forEach(({ moves }, n) => moves.forEach(([name, row, by]) => ((found[name] ??= blank(name))[row * count + n] += by)));
  const again = (column) => {
    const { name, refs, jumps } = column, others = new Set(refs.map(([other]) => other).filter((other) => found[other] && !jumps));
    if (!others.size) return undefined;
    const out = blank(name), sizes = new Float64Array(out.length / count), many = refs.filter(([other, , over]) => over !== null && found[other]?.length > count ** 2).map(([other]) => other);
    if (many.length) along(out, column, [...new Set(many)], found, sheet, count);
    for (const other of others) if (!many.includes(other)) chain(out, sizes, found[other], (known[`${name} ${other}`] ??= []), column, other, sheet, count);
    sizes.forEach((size, row) => {
      for (let n = row * count; n < (row + 1) * count; n++) if (Math.abs(out[n]) <= LEFT * size) out[n] = 0;
    });
    return out;
  };
  const put = ({ name }, effects) => {
    if (effects) found[name] = effects;
  };
  columns.forEach((column, n) => {
    if (!column.loop) put(column, again(column));
    else if (column.loop !== columns[n - 1]?.loop) settleEffects(columns.filter(({ loop }) => loop === column.loop), again, put, found);
  });
  return found;
}

// Passes until nothing moves that rounding does not move.
function settleEffects(loop, again, put, found) {
  const iterated = loop.filter(({ start }) => start), formulas = loop.filter(({ start }) => !start);
  const pass = () => formulas.forEach((column) => put(column, again(column)));
  const apart = (now, before) => Math.max(...now.map((one, n) => Math.abs(one - (before?.[n] ?? 0)))) / Math.max(...now.map(Math.abs)) || 0;
  for (let passes = 0, moved = Infinity; moved > STILL && passes < MOST_PASSES; passes++) {
    pass();
    const after = iterated.map(again);
    moved = Math.max(...iterated.map(({ name }, n) => (after[n] ? apart(after[n], found[name]) : 0)));
    iterated.forEach((column, n) => put(column, after[n]));
  }
  pass();
}

// Adds what errors do to a column by way of the cells of another. `known` has the slopes: they are asked for once, or
// again where a step turns out to be far too short or too long, in a loop.
function chain(out, sizes, effects, known, column, other, sheet, count) {
  const steps = stepsOf(sheet.value[other], effects, count), size = sheet.status[column.name].length;
  if (!known.length) known.push(...movedTogether(column, other, sheet));
  for (const part of known) {
    if (part.cells.some((cell) => steps[cell] && !(part.steps?.[cell] < 8 * steps[cell] && steps[cell] < 8 * part.steps[cell]))) askSlopes(part, column, other, steps, sheet);
    for (let row = 0; part.steps && row < size; row++) {
      const slope = part.slopes[row], cell = part.cell(row), from = cell * count, to = row * count;
      if (slope) sizes[row] += Math.abs(slope) * part.steps[cell];
      for (let n = 0; slope && n < count; n++) out[to + n] += slope * effects[from + n];
    }
  }
}

// How far each cell of a column is moved to be asked; 0 where no error moves it.
function stepsOf(values, effects, count) {
  const steps = new Float64Array(values.length);
  for (let cell = 0, at = 0; cell < steps.length; cell++) {
    let far = 0;
    for (const end = at + count; at < end; at++) far = Math.max(far, Math.abs(effects[at]));
    steps[cell] = far && Math.max(MOVE * far, LEAST * Math.abs(values[cell]));
  }
  return steps;
}

// The cells of a column that move together when another column is asked for its slopes by them, and which of them a row
// of that names: all, where each row names one; else one after another.
function movedTogether({ axis, refs }, other, { layouts, value }) {
  const mine = refs.filter(([each]) => each === other), cells = Array.from(value[other].keys());
  const whole = mine.some(([, index, over]) => index === null || over !== null), indices = new Set(whole ? [] : mine.map(([, index]) => index));
  const ways = Array.from(indices, (index) => layouts[axis].rows[index]);
  if (ways.length === 1) return [{ cells, cell: (row) => ways[0][row] }];
  return cells.map((cell) => ({ cells: [cell], cell: whole ? () => cell : (row) => (ways.some((rows) => rows[row] === cell) ? cell : -1) }));
}

// The slope of each row by the cell that it names.
function askSlopes(part, column, other, steps, sheet) {
  const codes = sheet.status[column.name], change = changes(column, sheet, [other], (_, far) => {
    const own = sheet.value[other].slice();
    for (const cell of part.cells) own[cell] += far * steps[cell];
    return own;
  });
  Object.assign(part, { steps, slopes: new Float64Array(codes.length) });
  for (let row = 0; row < codes.length; row++) {
    const cell = part.cell(row);
    if (!codes[row] && steps[cell]) part.slopes[row] = change(row) / steps[cell];
  }
}

// The same by way of all cells of others, which are moved together along one error after another.
function along(out, column, others, found, sheet, count) {
  const codes = sheet.status[column.name];
  for (let n = 0; n < count; n++) {
    const change = changes(column, sheet, others, (other, far) => {
      const own = sheet.value[other].slice(), effects = found[other];
      for (let row = 0, at = n; row < own.length; row++, at += count) own[row] += far * MOVE * effects[at];
      return own;
    });
    for (let row = 0; row < codes.length; row++) if (!codes[row]) out[row * count + n] += change(row) / MOVE;
  }
}

// How much each row of a column changes when others, which `moved` tells, go one step; straight on, as it does where it is.
function changes(column, sheet, others, moved) {
  const { value, layouts, kept } = sheet, { sizes, keep, unknown } = kept[column.name], steep = column.kind === "root" && steepness(sheet, column);
  const at = (far) => {
    const before = others.map((other) => value[other]);
    for (const other of others) value[other] = moved(other, far);
    const kernels = column.kernels(value, layouts, sizes, keep);
    others.forEach((other, n) => (value[other] = before[n]));
    // A root goes one step from where it was, which is right to first order.
    return steep ? (row) => kernels.value(row, unknown[row] - kernels.at(row, unknown[row]) / steep[row]) : kernels.value;
  };
  const [up, down] = [at(1), at(-1)];
  let further;
  return (row) => {
    const now = value[column.name][row], above = up(row) - now, below = now - down(row);
    if (Math.abs(above - below) <= BENT * Math.abs(above + below)) return (above + below) / 2;
    further ??= [at(2), at(-2)]; // where it bends, of fourth order
    return (8 * (above + below) - (further[0](row) - further[1](row))) / 12;
  };
}

// How fast the form of each root changes with what is sought.
function steepness({ value, layouts, kept }, { name, kernels }) {
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
