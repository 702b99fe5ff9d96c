// The tables whose rows come and go with the tests, and the cells that stand elsewhere.

const tableOf = (element) => page.tables.find((one) => one.element.contains(element));
const axisOf = (name) => page.look.trace.declared[name].axis;

// What the user gives, whose rows those of an index set are made of.
const beneath = (axis) => axis && (LIVE.tables[axis] ?? beneath(axisNamed(axis).of));

// Of rows in groups, to which a new one belongs is told by no cell of the page.
const isGrouped = (axis) => PROGRAM.axes.some(({ kind, of }) => kind === "members" && of === axis);

// A table of one index set: a row for each of its rows, and for the tests also for those that are left out.
class Table {
  constructor(element) {
    this.element = element;
    this.body = element.tBodies[0];
    const cells = all("[data-cell]", this.body.rows[0]);
    this.columns = cells.map((cell) => ({ name: cell.dataset.cell, identified: cell.id !== "" }));
    this.axis = PROGRAM.columns.find((column) => column.name === this.columns[0].name).axis;
    this.row = LIVE.tables[this.axis]?.row;
    this.inputs = this.columns.filter(({ name }) => LIVE.columns[name].given).map(({ name }) => name);
    this.words = all("thead th[class]", element);
    this.first = cells[0].dataset.index;
    this.labels = Object.fromEntries(cells.map((cell) => [cell.dataset.cell, cell.getAttribute("aria-label")]));
    this.editable = false;
    for (const row of this.body.rows) row.dataset.label = row.querySelector("[data-cell]").dataset.index;
  }

  // Lets tests be left out, removed and added here.
  makeEditable() {
    this.editable = true;
    this.element.tHead.rows[0].append(make("td", { class: "tools" }));
    for (const row of this.body.rows) this.addTools(row);
    const { axis, row: called } = this, add = isGrouped(axis)
      ? make("span", { class: "says" }, `A further ${called} is added in the table of measurements, with the word of its group; then build again.`)
      : make("button", { type: "button", id: byId("live-add") ? null : "live-add", "data-add": axis }, `Add ${/^[aeiou]/i.test(called) ? "an" : "a"} ${called}`);
    this.element.closest(".scroll").after(make("p", { class: "add" }, add));
  }

  addTools(row) {
    const label = row.dataset.label, head = row.cells[0], called = `${this.row} ${label}`;
    const { used, reason } = testAt(page.history.now, this.axis, label);
    const use = make("input", {
      type: "checkbox", checked: used, "data-use": label, tabindex: "-1", "aria-label": `use ${called}`,
    });
    head.replaceChildren(make("label", {}, use, ` ${label}`));
    const remove = make("button", {
      type: "button", "data-remove": label, tabindex: "-1", "aria-label": `remove ${called}`, title: `remove ${called}`,
    }, "×");
    const why = make("input", {
      type: "text", "data-reason": label, value: reason, maxlength: "500", autocomplete: "off",
      placeholder: "reason", "aria-label": `why ${called} is left out`,
    });
    row.append(make("td", { class: "tools" }, why, remove));
  }

  // What stands beside a row in a column of words: beside a group, what stands beside its tests.
  word(index, name) {
    const { kind, of } = axisNamed(this.axis);
    const its = kind === "groups" && Object.entries(LIVE.groups[of]).find(([, number]) => String(number) === index);
    return wordOf(its ? axisNamed(of).of : this.axis, its ? its[0] : index, name);
  }

  newRow(index) {
    const text = index.replaceAll("-", "–");
    const row = make("tr", { "data-label": index }, make("th", { scope: "row" }, text));
    for (const head of this.words) row.append(make("td", { class: head.className }, this.word(index, head.textContent)));
    for (const { name, identified } of this.columns) {
      const data = { id: identified ? cellId("cell", name, index) : null, "data-cell": name, "data-index": index };
      if (!LIVE.columns[name].given) {
        row.append(make("td", data));
        continue;
      }
      const label = this.labels[name].replace(`, ${this.first}`, `, ${index}`);
      row.append(make("td", {}, make("input", { ...data, ...INPUT_ATTRIBUTES, "aria-label": label })));
    }
    if (this.editable) this.addTools(row);
    return row;
  }

  // The rows that the table has now, by their index.
  wanted(look) {
    if (this.editable) return look.state.tables[this.axis].map((test) => String(test.label));
    return look.trace.sheet.layouts[this.axis].labels.slice(0, mostOf(this.element)).map((label) => label.join("-"));
  }

  // `last` is what the page shows now.
  write(look, last) {
    const wanted = this.wanted(look), rows = Array.from(this.body.rows);
    if (wanted.length !== rows.length || rows.some((row, n) => row.dataset.label !== wanted[n])) {
      const old = new Map(rows.map((row) => [row.dataset.label, row]));
      this.body.replaceChildren(...wanted.map((index) => old.get(index) ?? this.newRow(index)));
      page.places = null;
    }
    const scroll = this.element.closest(".scroll");
    scroll.classList.toggle("tall", wanted.length > 30);
    Array.from(this.body.rows).forEach((row, place) => this.writeRow(row, look, wanted[place], last));
  }

  writeRow(row, look, index, last) {
    const test = this.editable ? testAt(look.state, this.axis, index) : null;
    if (test) {
      row.classList.toggle("excluded", !test.used);
      const use = row.querySelector("[data-use]");
      use.checked = use.defaultChecked = test.used;
      setInput(row.querySelector("[data-reason]"), test.reason);
    }
    const boxes = all("[data-cell]", row);
    for (let n = 0; n < boxes.length; n++) {
      const { name } = this.columns[n], element = boxes[n], place = look.trace.row(name, index);
      if (!LIVE.columns[name].given && isUnchanged(look, last, name, place, last?.trace.row(name, index) ?? -1)) continue;
      if (place >= 0) writeCell(element, look, name, place);
      else if (test) writeLeftOut(element, test.cells[name]);
    }
  }
}

// How many rows of a table are shown: the first of so many that nobody would read them.
const mostOf = (table) => Number(table.dataset.most ?? Infinity);

// A cell of a test that is left out: its printed number stays, it has no part in anything.
function writeLeftOut(element, text) {
  element.removeAttribute("title");
  element.removeAttribute("aria-invalid");
  element.setAttribute("data-value", "");
  element.setAttribute("data-status", "");
  element.classList.remove("changed", "added");
  if (element.tagName === "INPUT") {
    setInput(element, text);
    element.parentElement.className = "";
    element.parentElement.querySelector("a.code")?.remove();
  } else {
    element.textContent = "";
  }
}

const INPUT_ATTRIBUTES = {
  inputmode: "decimal", autocomplete: "off", autocapitalize: "off", spellcheck: "false", tabindex: "-1", enterkeyhint: "done",
};

// --- outside of those tables -----------------------------------------------------------------------------

// How many tests, pairs ... there are, where the text says so.
function writeCounts(look) {
  for (const element of all("[data-count]")) {
    const { count, counted } = element.dataset;
    const rows = count === "left out" ? Object.values(page.history.now.tables).flat().filter(({ used }) => !used).length : look.trace.sheet.layouts[count].size;
    setText(element, String(look.trace.sheet.counted[counted]?.[count] || rows));
  }
  for (const element of all("[data-inside]")) {
    const { axis } = look.trace.declared[element.dataset.inside], [outside, size] = howMany(look, element.dataset.inside);
    setText(element, `${size - outside} of ${size} ${axis}`);
  }
}

// How many rows lie outside of a limit, of those for which that is known and tells something.
function howMany(look, margin) {
  const { value } = look.trace.sheet, beside = Object.values(LIVE.columns).map(({ limits }) => limits ?? []);
  const others = beside.find((limits) => limits.some(([name]) => name === margin)).filter(([name, , , silent]) => silent && name !== margin);
  const known = value[margin].filter((room, row) => room === room && !others.some(([name]) => value[name][row] < 0));
  return [known.filter((room) => room < 0).length, known.length];
}

// Beside the result: over how many rows it was taken, where some have no value, and how many carry marks.
function writeCounted(look) {
  for (const element of all(".headline [data-cell]")) {
    const box = element.parentElement, { sheet, declared } = look.trace, { cell: name, index } = element.dataset;
    const row = look.trace.row(name, index), counted = look.trace.isOk(name, row) ? Object.keys(sheet.counted[name] ?? {}) : [];
    for (const old of all(".counted", box)) {
      if (!old.previousSibling?.data?.trim()) old.previousSibling?.remove();
      old.remove();
    }
    for (const axis of counted) {
      // A result of a group sums the rows of its group.
      const { starts, size } = sheet.layouts[axis], ends = axisNamed(declared[name].axis)?.of === axis ? starts.slice(row, row + 2) : [0, size];
      const kept = sheet.kept[name].keep[axis].subarray(...ends), rows = sum(Array.from(kept));
      if (rows && rows < kept.length) box.append(" ", make("span", { class: "counted" }, `over ${rows} of ${kept.length} ${rowsOf(axis)}`));
    }
    const behind = look.trace.ancestors(name);
    for (const { name, axis } of look.trace.order.filter(({ name, axis }) => axis && behind.has(name))) {
      for (const [margin, mark, says] of LIVE.columns[name].limits ?? []) {
        const [outside, size] = howMany(look, margin), text = `${outside} of ${size} ${axis}${says ? "" : ":"} ${mark}`;
        if (outside) box.append(" ", make("span", { class: "counted" }, text));
      }
    }
  }
}

// The list of the cells to look at: where an error begins, or a limit ends; its section is made when there is one.
function writeMissing(look) {
  const { errors, order, sheet } = look.trace;
  const shown = byId("missing-cells")?.querySelector("table"), most = shown ? mostOf(shown) : Infinity;
  const remarks = errors.filter(({ name, row }) => !look.trace.isFaultless(name, row)).slice(0, most).map(({ name, row }) => [name, row, CODES[sheet.status[name][row]], look.trace.why(name, row)]);
  for (const { name } of order) {
    const marks = new Map();
    for (const [margin, mark, says] of LIVE.columns[name].limits ?? []) {
      const told = says ? `${mark}, ${says}` : mark;
      sheet.value[margin].forEach((room, row) => room < 0 && marks.set(row, [...marks.get(row) ?? [], told]));
    }
    for (const [row, told] of marks) remarks.push([name, row, "†", told.join("; ")]);
  }
  let section = byId("missing");
  if (!section && remarks.length) {
    section = byId("live-missing").content.querySelector("section").cloneNode(true);
    const before = byId("published") ?? byId("equations") ?? byId("reproduce");
    if (before) before.before(section);
    else byId("main").append(section);
  }
  if (!section) return;
  section.hidden = remarks.length === 0;
  byId("missing-cells").querySelector("tbody").replaceChildren(
    ...remarks.slice(0, most).map(([name, row, code, why]) => {
      const index = look.trace.index(name, row);
      return make(
        "tr", code === "†" ? {} : { id: cellId("why", name, index) },
        make("th", { scope: "row" }, make("abbr", { title: meaningOf(name) }, ...part(name, "symbol"))),
        make("td", { class: "row" }, index.replaceAll("-", "–")),
        make("td", { class: "w" }, make("code", {}, code)),
        make("td", { class: "w" }, why),
      );
    }),
  );
}
