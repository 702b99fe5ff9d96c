// One cell of the page: what it shows, and how it is written into whatever element shows it.

// What the cells of a sheet look like, column by column, computed when asked for.
class Look {
  constructor(trace, state, issued) {
    this.trace = trace;
    this.state = state;
    this.issued = issued;
    this.known = {};
  }

  // The printed texts of a given column, row by row.
  texts(name) {
    const axis = this.trace.declared[name].axis;
    return axis === null ? [this.state.parameters[name]] : usedTests(this.state, axis).map((test) => test.cells[name]);
  }

  get sure() {
    return (this.found ??= new Sure(this));
  }

  // The power of ten of the last digit of a computed cell: its uncertainty says it, in which terms of second order stay as
  // issued, or are less as those of first order are, or the value. Where all of it stays, so does the number of digits.
  place(name, row) {
    const { digits, scale, zero, kept, bent } = LIVE.columns[name], index = this.trace.index(name, row), x = this.trace.sheet.value[name][row], value = (x - zero) / scale;
    const own = kept?.[index] ?? (LIVE.shared ? 0 : digits);
    if (own) return order(value) - own + 1;
    const first = this.sure.u(name, row) ** 2, [second, issued, before] = bent?.[index] ?? [0], less = before ? first / before : x / issued;
    return lastPlace(value, Math.sqrt(first + second * Math.min(1, less ** 2 || 0)) / scale, digits, LIVE.most);
  }

  column(name) {
    if (this.known[name]) return this.known[name];
    const { scale, zero, given } = LIVE.columns[name], texts = given && this.texts(name);
    const figures = given
      ? texts.map(readFigure)
      : shownColumn(Array.from(this.trace.sheet.value[name], (value) => (value - zero) / scale), (row) => this.place(name, row));
    const places = figures.reduce((most, figure) => Math.max(most, figure?.fraction.length ?? 0), 0);
    return (this.known[name] = { texts, figures, places });
  }

  cell(name, row) {
    const { texts, figures, places } = this.column(name), figure = figures[row];
    const code = CODES[this.trace.sheet.status[name][row]];
    const index = this.trace.index(name, row), missing = figure ? places - figure.fraction.length : 0;
    const before = this.issued?.trace.row(name, index);
    const same = before >= 0 && isSameCell(this, name, row, this.issued, before);
    return {
      name, row, index, code, ok: code === "ok", printed: texts?.[row] ?? null,
      text: code !== "ok" ? code : figure ? figureText(figure) : texts[row],
      data: repr(this.trace.sheet.value[name][row]),
      pad: missing > 0 ? `p${Math.min(missing, 8)}${figure.fraction ? "" : " nopoint"}` : "",
      beyond: code === "ok" ? this.trace.outsideOf(name, row).map(([, mark]) => mark).join("; ") : "",
      mark: !this.issued || same ? "" : before >= 0 ? "changed" : "added",
      before: before >= 0 && !same ? this.issued.shownText(name, before) : "",
    };
  }

  // The number as the report prints it, with its unit.
  shownText(name, row) {
    const { texts, figures } = this.column(name), shown = figures[row];
    if (!this.trace.isOk(name, row)) return CODES[this.trace.sheet.status[name][row]];
    const text = shown ? figureText(shown) : texts[row];
    const { unit } = LIVE.columns[name];
    return unit === "1" ? text : `${text} ${unit}`;
  }
}

// The same of a row by its index, which may be gone.
function textAt(look, name, index) {
  const row = look.trace.row(name, index);
  return row < 0 ? "–" : look.shownText(name, row);
}

function isSameCell(look, name, row, other, before) {
  const a = look.trace.sheet, b = other.trace.sheet;
  if (a.status[name][row] !== b.status[name][before]) return false;
  if (LIVE.columns[name].given) return look.texts(name)[row] === other.texts(name)[before];
  return look.trace.isOk(name, row) ? a.value[name][row] === b.value[name][before] : true;
}

// Whether a computed cell looks as it did: then the page is left alone.
function isUnchanged(look, last, name, row, before) {
  if (!last?.issued || before < 0 || LIVE.columns[name].limits) return false;
  const now = look.trace.sheet, then = last.trace.sheet;
  if (now.value[name][row] !== then.value[name][before] || now.status[name][row] || then.status[name][before]) return false;
  const form = look.column(name), old = last.column(name);
  const [one, other] = [form.figures[row], old.figures[before]];
  return one.exponent === other.exponent && one.fraction === other.fraction && form.places === old.places;
}

function writeCell(element, look, name, row) {
  if (row < 0) { // of a group that has no row left
    element.setAttribute("data-value", "");
    writeInText(element, { text: "–", ok: false });
    return;
  }
  const cell = look.cell(name, row);
  const reason = cell.ok ? "" : look.trace.reason(name, row);
  const title = [reason || cell.beyond, cell.before && `as issued: ${cell.before}`].filter(Boolean).join("; ");
  element.setAttribute("data-value", cell.ok ? cell.data : "");
  element.setAttribute("data-status", cell.code);
  for (const [name, text] of [["title", title], ["data-mark", cell.beyond]]) {
    if (text) element.setAttribute(name, text);
    else element.removeAttribute(name);
  }
  if (element.tagName === "TD") {
    writeComputed(element, look, cell);
    return;
  }
  element.classList.toggle("changed", cell.mark === "changed");
  element.classList.toggle("added", cell.mark === "added");
  if (element.tagName === "INPUT") writeInput(element, look, cell);
  else writeInText(element, cell);
}

function codeLink(look, { name, row, code }) {
  const origin = look.trace.culprit(name, row), index = look.trace.index(origin.name, origin.row);
  return make("a", { href: `#${cellId("why", origin.name, index)}`, tabindex: "-1" }, code);
}

// What the formula bar marks, it marks again after every edit.
function writeComputed(element, look, cell) {
  element.className = `${cell.ok ? cell.pad : "error"} ${cell.mark}`.trim();
  if (cell.ok) setText(element, cell.text);
  else element.replaceChildren(codeLink(look, cell));
}

function writeInput(element, look, cell) {
  setInput(element, cell.printed);
  element.setAttribute("size", Math.max(2, cell.printed.length));
  const box = element.parentElement;
  box.className = cell.ok ? cell.pad : "error";
  box.querySelector("a.code")?.remove();
  if (cell.ok) element.removeAttribute("aria-invalid");
  else {
    element.setAttribute("aria-invalid", "true");
    const link = codeLink(look, cell);
    link.className = "code";
    element.after(link);
  }
}

// In its source, too: a page that a browser stores shows the inputs of its numbers.
function setInput(element, text) {
  element.defaultValue = text;
  element.value = text;
}

function writeInText(element, cell) {
  setText(element, cell.text);
  element.classList.toggle("error", !cell.ok);
  // A code has no unit.
  const unit = element.nextElementSibling;
  if (unit?.classList.contains("unit")) unit.hidden = !cell.ok;
}
