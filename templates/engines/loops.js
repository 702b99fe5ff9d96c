// Columns that rest on one another, as a program with such columns brings them along: passes until nothing moves
// that rounding does not move.
// Those of a fit begin where `begun` says, by their name, rather than at their author's start.
function settle(loop, compute, put, { layouts, value, status }, faulty, begun) {
  const iterated = loop.filter(({ start }) => start), formulas = loop.filter(({ start }) => !start);
  for (const column of loop) put(column, [[], new Uint8Array(column.axis === null ? 1 : layouts[column.axis].size)]);
  // First of all, until all know of the errors before the loop that reach them.
  for (let before, now = ""; before !== now; ) {
    before = now;
    for (const column of loop) put(column, compute(column, "errors"));
    now = loop.map(({ name }) => status[name].join()).join();
  }
  const starts = iterated.map((column) => {
    const [out, codes] = compute(column, "start"), found = [column.name in begun && !codes[0] ? [begun[column.name]] : out, codes];
    put(column, found);
    return found;
  });
  const pass = () => formulas.forEach((column) => put(column, compute(column)));
  for (let passes = 1, last = Infinity, before = last; ; passes++) {
    pass();
    const after = iterated.map((column) => compute(column));
    let moved = 0, lost = false;
    after.forEach(([out, codes], n) => out.forEach((now, row) => {
      if (codes[row] !== starts[n][1][row]) lost = true;
      else if (!codes[row]) moved = Math.max(moved, Math.abs((now - value[iterated[n].name][row]) / now) || 0);
    }));
    const still = moved <= 2 ** (passes === 100 ? -44 : -51) || (moved <= 2 ** -30 && moved >= before);
    if (lost || (!still && passes === 100)) {
      for (const [n, column] of iterated.entries()) {
        faulty[column.name] = true;
        put(column, [starts[n][0].fill(NaN), starts[n][1].map((code) => code || STATUS.NOROOT)]);
      }
      return pass();
    }
    iterated.forEach((column, n) => put(column, after[n]));
    if (still) return pass();
    before = last;
    last = moved;
  }
}
