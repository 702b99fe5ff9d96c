// How sure the cells are: the errors of what was given, and what they do to each cell, by the law of propagation of
// uncertainty (JCGM 100, 5.1 and 5.2), to first order; and with what a worker finds that terms of second order add.

const CELLS = PROGRAM.columns.filter(({ name }) => LIVE.columns[name]);

const LITTLE_OF = 1e-3; // of u: the degrees of freedom of what contributes no more do not count
const ROUNDED = 2 ** -41, NEAR_SLOPE = 2 ** -22; // of a value; of one that moves

// Every independent error of a state: what it is called, and what it moves, by one standard uncertainty.
function* errorsIn(look) {
  for (const { name, axis } of CELLS) {
    const column = LIVE.paired ? withScatter(look, name) : LIVE.columns[name], texts = column.given && !column.given.bounds.integer ? look.texts(name) : [];
    for (const [row, text] of texts.entries()) {
      const index = look.trace.index(name, row), own = errorsOf(column, index, text), called = look.trace.address(name, row);
      for (const error of own) yield { ...error, called: own.length > 1 ? `${called}, ${error.said}` : called, moves: [[name, row, error.u]] };
    }
  }
  const together = {};
  for (const { called, of, groups, ...error } of LIVE.shared) {
    const column = LIVE.columns[of], texts = look.texts(of), every = texts.map((_, row) => look.trace.index(of, row));
    for (const group of groups ?? [every]) {
      const rows = group.map((label) => every.indexOf(String(label))).filter((row) => row >= 0);
      const found = rows.map((row) => errorsOf({ ...column, errors: [error] }, "", texts[row])[0]);
      // A gain moves -5 V down and 5 V up.
      const sign = (row) => (error.gain && look.trace.sheet.value[of][row] < 0 ? -1 : 1);
      const moves = rows.flatMap((row, n) => (found[n] ? [[of, row, sign(row) * found[n].u]] : []));
      const { axis } = look.trace.declared[of], named = groups ? ` (${group.length > 1 ? axis : LIVE.tables[axis].row} ${group.join(", ")})` : "";
      if (moves.length) (together[called + named] ??= { ...error, called: called + named, moves: [] }).moves.push(...moves);
    }
  }
  yield* Object.values(together);
}

// What is known of the uncertainty of a sheet's cells, computed when asked for.
class Sure {
  constructor(look) {
    this.trace = look.trace;
    this.errors = [...errorsIn(look)];
    const place = (called) => this.errors.findIndex((error) => error.called === called);
    this.pairs = (LIVE.paired ? correlations(look) : LIVE.correlated).flatMap(([one, other, r]) => {
      const rows = [...this.trace.sheet.value[one].keys()].map((row) => [one, other].map((name) => place(this.trace.address(name, row))));
      return rows.filter((both) => !both.includes(-1)).map((both) => [...both, r]);
    });
    [this.known, this.told, this.more] = [{}, {}, {}];
  }

  // What terms of second order add to the variance of a cell: NaN if nobody knows.
  learn([name, row], more) {
    this.more[[name, row]] = more;
    delete this.told[name];
  }

  // The columns whose uncertainty is told, and those that they rest on: not the points of a curve that is only drawn.
  asked() {
    const own = CELLS.filter(({ axis }) => axisNamed(axis)?.kind !== "repeat"), found = new Set(own.map(({ name }) => name));
    for (const { name } of own) this.trace.ancestors(name, found);
    return CELLS.filter(({ name }) => found.has(name));
  }

  // What each error does to a cell, in SI, with its sign.
  parts(name, row) {
    const { length } = this.errors;
    this.effects ??= sensitivities(this.asked(), this.trace.sheet, this.errors);
    return this.effects[name]?.subarray(row * length, (row + 1) * length) ?? new Float64Array(length);
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

  // Why nothing is known of the uncertainty of a cell, if it rests on a number without one.
  lacking(name, row) {
    const at = this.errors.some(({ unknown }) => unknown) ? this.parts(name, row).findIndex((part, n) => part && this.errors[n].unknown) : -1;
    return at < 0 ? "" : `not known: nothing states u of ${this.errors[at].called}`;
  }

  // The combined standard uncertainty of a cell; NaN where nothing is known of it.
  u(name, row) {
    const { axis } = this.trace.declared[name];
    if (axisNamed(axis)?.kind === "repeat" || !this.trace.isOk(name, row) || this.lacking(name, row)) return NaN;
    return ((this.known[name] ??= [])[row] ??= this.combined(name, row));
  }

  // What is no more than the rounding of slopes that are 0 is nothing: a slope is the change of a double, of 53 bits, over
  // the step that it is asked by (MOVE and LEAST of sensitivities.js).
  combined(name, row) {
    const parts = this.parts(name, row), u = Math.sqrt(Math.max(0, sum(this.variances(parts)))), { value } = this.trace.sheet;
    const far = Math.max(...this.errors.map(({ moves }, n) => (parts[n] ? Math.max(...moves.map(([of, at, by]) => Math.abs(by / value[of][at]))) : 0)));
    return LIVE.columns[name].given || u > ROUNDED * Math.min(1, far / NEAR_SLOPE) * Math.abs(value[name][row]) ? u : 0;
  }

  // Where the uncertainty of a cell comes from, the largest first, and its coverage factor.
  budget(name, row) {
    return ((this.told[name] ??= [])[row] ??= this.sources(name, row));
  }

  sources(name, row) {
    const parts = this.parts(name, row), first = this.u(name, row), more = this.more[[name, row]] || 0, u = Math.sqrt(first ** 2 + more), variances = this.variances(parts), least = 1e-12 * Math.max(...parts.map(Math.abs));
    const from = this.errors.map((error, n) => ({ ...error, part: parts[n], share: variances[n] / u ** 2 }));
    const factor = this.factor(parts, variances, this.freedom(parts, variances, first), u, more);
    return { u, factor, second: more / u ** 2, from: from.filter(({ part }) => Math.abs(part) > least).sort((a, b) => Math.abs(b.share) - Math.abs(a.share)) };
  }

  // Effective degrees of freedom (JCGM 100, G.2b): errors of one sample are one estimate. NaN if correlated ones have any.
  freedom(parts, variances, u) {
    const samples = this.errors.map(({ sample }, n) => sample ?? n), found = new Map();
    const apart = this.pairs.filter(([a, b]) => Math.min(Math.abs(parts[a]), Math.abs(parts[b])) > LITTLE_OF * u && samples[a] !== samples[b]);
    if (apart.some(([a, b]) => this.errors[a].dof || this.errors[b].dof)) return NaN;
    variances.forEach((one, n) => found.set(samples[n], (found.get(samples[n]) ?? 0) + one));
    const below = sum(this.errors.map(({ dof }, n) => {
      const own = found.get(samples[n]);
      found.delete(samples[n]);
      return dof && own > 0 ? (own / u ** 2) ** 2 / dof : 0;
    }));
    return below > 1e-9 ? Math.max(1, Math.floor(Math.round(100 / below) / 100)) : Infinity;
  }

  // From the sum of the errors, where they are not all normal or t; as a rebuild tells it (uncertainty/coverage.py).
  factor(parts, variances, freedom, u, more) {
    const { errors, pairs } = this;
    // With terms of second order they are no sum: the shape is that of an error that dominates all else, or normal.
    if (more) {
      const sizes = parts.map(Math.abs), most = Math.max(...sizes), { shape, dof } = errors[sizes.indexOf(most)];
      const alone = ENDED[shape] && !dof && sum(parts.map((part) => part ** 2)) - most ** 2 + Math.abs(more) <= (DOMINANT * most) ** 2;
      return alone ? summedFactor([{ shape, size: 1 }]) : studentFactor(freedom);
    }
    const mixed = new Set(pairs.flatMap(([a, b]) => (parts[a] && parts[b] ? [a, b] : [])));
    const ended = errors.map(({ shape }, n) => Boolean(parts[n] && !mixed.has(n) && ENDED[shape]));
    if (!freedom || !ended.includes(true) || errors.some(({ dof, shape }, n) => parts[n] && dof && shape !== "t")) return studentFactor(freedom);
    // All others are one error, as they are where nothing else is.
    const rest = variances.map((one, n) => (ended[n] ? 0 : one)), size = Math.sqrt(Math.max(0, sum(rest))), dof = this.freedom(parts, rest, size);
    const own = errors.flatMap(({ shape }, n) => (ended[n] ? { shape, size: Math.sqrt(variances[n]) / u } : []));
    return summedFactor([...own, { shape: "t", size: size / u, ...(dof < Infinity && { dof }) }]);
  }
}

// --- told ------------------------------------------------------------------------------------------------

const percent = (share) => `${figureText(decimals(100 * share, 0))}\u00a0%`;

// The standard uncertainty of a cell in its unit, where it is known and more than nothing; not where terms of second order
// counted as issued, until it is known what they add.
function knownU(look, name, row) {
  if (!LIVE.shared || row < 0) return 0;
  const { scale, kept, bent } = LIVE.columns[name], index = look.trace.index(name, row), more = look.sure.more[[name, row]];
  const u = kept?.[index] || (bent?.[index] && more === undefined) ? 0 : Math.sqrt(look.sure.u(name, row) ** 2 + (more || 0));
  return u > 0 && u < Infinity && u / scale;
}

// Value, u, k and U of a cell, as texts, and its budget; nothing where there is none.
function sureOf(look, name, row) {
  const { scale, zero } = LIVE.columns[name];
  if (!knownU(look, name, row)) return null;
  const { u, factor, from, second } = look.sure.budget(name, row), value = (look.trace.sheet.value[name][row] - zero) / scale;
  const of = (width) => stated(value, width / scale, LIVE.most).map(figureText), known = factor > 0;
  return { texts: [...of(u), known ? figureText(rounded(factor, order(factor) - 2)) : "", known ? of(factor * u)[1] : ""], from, second };
}

// Why U may not hold, or is not known: as issued, until a worker has looked at what second order adds.
function doubtOf(look, name, row) {
  const more = LIVE.shared ? look.sure.more[[name, row]] : undefined, { floor, doubt } = LIVE.columns[name];
  if (more === undefined) return doubt;
  if (!knownU(look, name, row)) return Number.isNaN(more) && look.trace.isOk(name, row) ? "U is not known: second order was not looked at" : "";
  const { u, factor } = look.sure.budget(name, row), low = floor || look.trace.declared[name].positive ? 0 : -Infinity;
  const fails = Math.abs(more) > look.sure.u(name, row) ** 2 || look.trace.sheet.value[name][row] - factor * u < low;
  if (!(factor > 0)) return doubt;
  if (more === 0) return "";
  return `U ${fails ? "does" : "may"} not hold: second order ${more ? "counts" : "was not looked at"}${fails ? `; use loopsheet budget ${look.trace.address(name, row)} --draws 1000000` : ""}`;
}

// The same of all results, below their table.
function writeDoubts(look, cells) {
  const found = {};
  for (const [name, row] of cells) {
    const doubt = row >= 0 && (doubtOf(look, name, row) ?? "").split(";")[0];
    if (doubt) (found[doubt] ??= []).push(look.trace.address(name, row));
  }
  const told = Object.entries(found).flatMap(([doubt, names]) => [`${doubt} (`, ...names.flatMap((name, n) => [n ? (n < names.length - 1 ? ", " : " and ") : "", make("code", {}, name)]), "). "]);
  page.doubts?.[1].replaceChildren(...told, ...(told.length ? [make("code", {}, "loopsheet budget CELL --draws 1000000"), " tells the interval."] : []));
}

// The results with their uncertainties, again: in their table, and where they stand first.
function writeUncertain(look) {
  const cells = [];
  for (const line of LIVE.shared ? all("#uncertain tbody tr") : []) {
    const [, name, index = ""] = ADDRESS.exec(line.cells[0].textContent), row = look.trace.row(name, index);
    cells.push([name, row]);
    const known = sureOf(look, name, row), shown = row < 0 ? "–" : look.cell(name, row).text;
    const { texts, from, second } = known || { texts: [shown, "", "", ""], from: [] };
    texts.forEach((text, n) => setText(line.cells[n + 1], text));
    const lacking = row >= 0 && !known && look.sure.lacking(name, row);
    const most = estimates(look, from).slice(0, 3).filter(({ share }) => share >= 0.05);
    const told = most.map(({ called, rows, share }) => [make("code", {}, called), `${rows}\u00a0${percent(share)}`]);
    if (second) told.push([`second order\u00a0${percent(second)}`]);
    line.cells[6].replaceChildren(...lacking ? [lacking] : told.flatMap((one, n) => (n ? [", ", ...one] : one)));
  }
  for (const told of LIVE.shared ? all(".headline .sure") : []) {
    const box = told.parentElement, { cell: name, index } = box.querySelector("[data-cell]").dataset, row = look.trace.row(name, index), [, u, factor, wide] = sureOf(look, name, row)?.texts ?? [];
    told.replaceChildren(...(wide ? [`U\u00a0=\u00a0${wide}`, ...behind(name), ` (k\u00a0=\u00a0${factor})`] : []));
    const doubt = u || Number.isNaN(look.sure.more[[name, row]]) ? doubtOf(look, name, row) : "", at = box.querySelector(".doubt") ?? (doubt && make("span", { class: "doubt" }));
    if (at && !at.isConnected) told.after(at);
    if (at) at.replaceChildren(...(doubt ?? "").split(/(loopsheet .*)/).filter(Boolean).map((text, n) => (n ? make("code", {}, text) : text)));
  }
  writeDoubts(look, cells);
}

// Errors of one sample together, as one estimate, the largest sum first; with the cell that one moves alone.
function estimates({ trace }, from) {
  const found = new Map();
  for (const one of from) {
    const key = one.sample ?? `${one.called} alone`;
    found.set(key, [...(found.get(key) ?? []), one]);
  }
  const told = [...found.values()].map((own) => {
    const [{ called, moves: [[column, row], more] }] = own, share = sum(own.map(({ share }) => share));
    const [columns, rows] = [0, 1].map((part) => new Set(own.map(({ moves: [move] }) => move[part]))); // readings that are paired
    if (own.length > 1) return { called: [...columns].join(", "), rows: ` (${rows.size}\u00a0${trace.declared[column].axis})`, share };
    return { called, rows: "", share, goto: more ? null : trace.address(column, row) };
  });
  return told.sort((a, b) => Math.abs(b.share) - Math.abs(a.share));
}

const ADDRESS = /^(\w+)(?:\[(.*)\])?$/;
const axisNamed = (name) => PROGRAM.axes.find((one) => one.name === name);
