// What a cell rests on, what rests on it, and where an error began. Nothing in this file knows the page.

const BEYOND = "it, or a step towards it, is above 1.8e308, or positive and below 2.2e-308";

// What the page is told of the columns, with what goes without saying.
function wholeColumns(columns) {
  const whole = ([name, one]) => [name, { unit: "1", scale: 1, zero: 0, digits: one.given || one.of ? undefined : 4, ...one }];
  return Object.fromEntries(Object.entries(columns).map(whole));
}

class Trace {
  constructor(program, columns, sheet, words = {}) {
    this.columns = columns;
    this.words = words;
    this.sheet = sheet;
    this.declared = Object.fromEntries(program.columns.map((column) => [column.name, column]));
    // What is only drawn is no cell of the report.
    this.order = program.columns.filter(({ name }) => columns[name]);
    [this.found, this.origins] = [{}, {}];
    const limits = Object.values(columns).flatMap((column) => column.limits ?? []);
    this.silent = new Set(limits.filter(([, , , silent]) => silent).map(([, mark]) => mark));
  }

  size(name) {
    return this.sheet.value[name].length;
  }

  // How a row is called: [2], [1, 2], [] for a scalar.
  label(name, row) {
    const axis = this.declared[name].axis;
    return axis === null ? [] : this.sheet.layouts[axis].labels[row];
  }

  index(name, row) {
    return this.label(name, row).join("-");
  }

  // What a group is called, which stands for the number of its row.
  word(name, row) {
    const word = this.words[this.declared[name].axis]?.[this.index(name, row)];
    return /^[\d-]*$|[[\]]/.test(word) ? undefined : word; // which would be read as a number
  }

  address(name, row) {
    const index = this.word(name, row) ?? this.index(name, row);
    return index ? `${name}[${index}]` : name;
  }

  // The row of an index such as "1-2", or of a group's word; -1 if there is none.
  row(name, index) {
    const axis = this.declared[name]?.axis;
    if (axis === undefined) return -1;
    if (axis === null) return index === "" ? 0 : -1;
    const { labels } = this.sheet.layouts[axis];
    this.found[axis] ??= new Map([
      ...labels.map((_, row) => [this.word(name, row), row]),
      ...labels.map((label, row) => [label.join("-"), row]), // a number is nobody's word
    ]);
    return this.found[axis].get(index) ?? -1;
  }

  isOk(name, row) {
    return this.sheet.status[name][row] === STATUS.OK;
  }

  // The cells that a cell is computed from: for each name in its rule the rows that it stands for.
  precedents(name, row) {
    const column = this.declared[name];
    return column.refs.map(([other, index, over]) => {
      const named = index === null ? [0] : this.sheet.layouts[over ?? column.axis].rows[index];
      const many = index !== null && over !== null, [first, end] = many ? summed(this.sheet.layouts[over], row) : [0];
      return { name: other, over, rows: many ? Array.from(named).slice(first, end) : [named[index === null ? 0 : row]] };
    });
  }

  // The cells that are computed from a cell directly.
  dependents(name, row) {
    const found = [];
    for (const column of this.order) {
      const rows = new Set();
      for (const [other, index, over] of column.refs) {
        if (other !== name) continue;
        const own = over === null && index !== null, all = this.size(column.name);
        const named = index === null ? null : this.sheet.layouts[over ?? column.axis].rows[index];
        const names = (n) => named === null || named.slice(...summed(this.sheet.layouts[over], n)).includes(row);
        if (!own) for (let n = 0; n < all && (names(n) || this.sheet.layouts[over]?.starts); n++) names(n) && rows.add(n);
        else for (let n = 0; n < all; n++) if (named[n] === row) rows.add(n);
      }
      if (rows.size) found.push({ name: column.name, rows: [...rows].sort((a, b) => a - b) });
    }
    return found;
  }

  // The cell where an error began: the first precedents in error, followed to their end.
  culprit(name, row) {
    // Of what a loop iterates, none is to blame for the others.
    const found = this.origin(name, row, []) ?? { name, row }, { loop, start } = this.declared[name];
    return start && this.declared[found.name].loop === loop ? { name, row } : found;
  }

  // Only in a loop one may come back to a cell, which is then in `seen`.
  origin(name, row, seen) {
    const known = (this.origins[name] ??= []), { loop } = this.declared[name], here = loop && this.address(name, row);
    if (!loop && known[row] !== undefined) return known[row];
    if (seen.includes(here)) return null;
    if (loop) seen.push(here);
    const wrong = this.wrong(name, row);
    let found = wrong[0] ? null : { name, row };
    for (const { name: other, rows } of wrong) found ??= this.origin(other, rows[0], seen);
    return (known[row] = found);
  }

  // The precedents in error, first those before its loop; a loop that did not settle is where it began.
  wrong(name, row) {
    const { loop, start } = this.declared[name], failed = start && this.sheet.status[name][row] === STATUS.NOROOT;
    const inside = (other) => !!loop && this.declared[other].loop === loop;
    const every = this.precedents(name, row).sort((a, b) => inside(a.name) - inside(b.name));
    return every.filter(({ name: other, rows, over }) => {
      // A sum is in error only if no row has a value.
      const [first, end] = over === null ? [] : summed(this.sheet.layouts[over], row);
      if (over !== null && this.sheet.kept[name].keep[over].subarray(first, end).some(Boolean)) return false;
      return rows.length && !this.isOk(other, rows[0]) && !(failed && inside(other));
    });
  }

  // What limits a cell lies outside of.
  outsideOf(name, row) {
    return (this.columns[name].limits ?? []).filter(([margin]) => this.sheet.value[margin][row] < 0);
  }

  // Whether an error begins where nobody is to blame: in a spare column, as a silent limit says, or in a column
  // of a loop for which another one tells.
  isFaultless(name, row) {
    const { spare, requires, limits = [] } = this.columns[name], number = this.sheet.broken?.[name]?.[row];
    return (spare && (number || this.sheet.status[name][row] === STATUS.NOROOT))
      || (number && this.silent.has(requires[number - 1]))
      || limits.some(([margin, , , silent]) => silent && this.sheet.value[margin][row] < 0);
  }

  // All columns that a column is computed from.
  ancestors(name, found = new Set()) {
    for (const [other] of this.declared[name].refs) if (!found.has(other)) this.ancestors(other, found.add(other));
    return found;
  }

  // Why a cell where an error begins has no value.
  why(name, row) {
    const { source, none, two, unknown, requires, unit, scale, zero } = this.columns[name], status = this.sheet.status[name][row];
    // In the unit of the cell; those of another unknown as they are.
    const own = (root) => `${brief((root - zero) / scale)}${unit === "1" ? "" : ` ${unit}`}`;
    const roots = Array.from(this.sheet.roots[name]?.[row] ?? [], unknown && status === STATUS.UNDECIDED ? brief : own);
    if (status === STATUS.INPUT) return this.sheet.refused[name]?.[row] ?? "the datum is missing or invalid";
    if (status === STATUS.NOROOT) return `${source} ${this.columns[none]?.none ?? none}`;
    if (status === STATUS.TWOROOTS) {
      return `${source} has more than one root here: ${roots.join(" and ")} (${two})`;
    }
    if (status === STATUS.UNDECIDED) {
      return `the roots of ${source} cannot be counted near ${unknown ?? name} = ${[...new Set(roots)].join(" to ")}: it may touch zero, jump, or cross it too often`;
    }
    if (status === STATUS.OVERFLOW) return `${source} has a value here that no double holds: ${BEYOND}`;
    return `outside the domain of ${source}: ${this.outside(name, row, requires ?? [])}`;
  }

  // Which condition does not hold, or that the formula gives no number.
  outside(name, row, requires) {
    const { sums, positive } = this.declared[name], { broken, layouts } = this.sheet;
    if (broken?.[name]?.[row]) return requires[broken[name][row] - 1];
    const empty = sums.find((axis) => layouts[axis].size === 0);
    if (!empty && this.columns[name].two) return "it has no value at an end of the interval of its root, or its root gives none";
    return empty ? `${empty} has no rows` : `it ${positive ? "has to be positive" : "gives no finite number here"}`;
  }

  // The sentence that a cell without a value shows.
  reason(name, row) {
    const code = CODES[this.sheet.status[name][row]], origin = this.culprit(name, row), here = this.address(name, row);
    const why = this.why(origin.name, origin.row);
    const itself = origin.name === name && origin.row === row;
    return itself ? `${code} ${here}: ${why}` : `${code} ${here} needs ${this.address(origin.name, origin.row)}: ${why}`;
  }

  // All cells where an error begins.
  get errors() {
    if (this.begun) return this.begun;
    this.begun = [];
    for (const { name } of this.order) {
      const codes = this.sheet.status[name];
      for (let row = 0; row < codes.length; row++) {
        if (codes[row] === STATUS.OK) continue;
        const origin = this.culprit(name, row);
        if (origin.name === name && origin.row === row) this.begun.push(origin);
      }
    }
    return this.begun;
  }
}
