// The keyboard of a spreadsheet. A cell of a table has the focus; typing replaces what is in it, F2 or a
// second click edits it in place, and until Enter or Tab nothing is computed.

let editing = null; // { element, before, inPlace }

const STOPS = "input:not([data-reason]), button, td[data-cell], td[data-published]";
const gridOf = (element) => element.closest?.("table[role=grid]");
const stopsOf = (row) => all(STOPS, row);
const isText = (element) => element?.tagName === "INPUT" && element.hasAttribute("data-cell");

function makeGrids() {
  const tables = new Set(all("main table").filter((table) => table.querySelector("tbody :is([data-cell], [data-published])")));
  for (const table of tables) {
    table.setAttribute("role", "grid");
    if (!table.querySelector("input[data-cell]")) table.setAttribute("aria-readonly", "true");
    else for (const cell of all("tbody td[data-cell]", table)) cell.setAttribute("aria-readonly", "true");
    table.querySelector(`tbody :is(${STOPS.replace("input", "input[data-cell]")})`)?.setAttribute("tabindex", "0");
  }
}

// Gives a cell the focus and makes it the one that Tab comes back to.
function enter(element) {
  pick();
  const grid = gridOf(element);
  if (grid) {
    for (const other of all("tbody [tabindex='0']", grid)) {
      if (other !== element) other.setAttribute("tabindex", "-1");
    }
    element.setAttribute("tabindex", "0");
  }
  element.focus({ preventScroll: grid === null });
  if (isText(element)) element.select();
}

const placeOf = (element) => {
  const row = element.closest("tr");
  return { grid: gridOf(element), row: row.sectionRowIndex, stop: stopsOf(row).indexOf(element) };
};

function stopAt({ grid, row, stop }) {
  const rows = grid.tBodies[0].rows, there = rows[Math.max(0, Math.min(row, rows.length - 1))];
  const stops = stopsOf(there);
  return stops[Math.max(0, Math.min(stop, stops.length - 1))];
}

// The cell that an element shows: its name and its index.
const cellOf = ({ dataset }) => dataset.published?.split(" ") ?? [dataset.cell, dataset.index];

// Enters what was typed and goes on to what `next` finds. The bar learns first where that is, and is written
// once; the focus comes last, for it makes the browser lay out the page.
function commitAndEnter(next) {
  const there = editing && next();
  if (there?.dataset.cell) [bar.name, bar.index] = cellOf(there);
  commit();
  const element = next(); // an element of the same place: an edit may have replaced the other
  if (element) enter(element);
}

// --- editing ---------------------------------------------------------------------------------------------

function beginEditing(element, inPlace) {
  if (editing?.element === element) editing.inPlace ||= inPlace;
  else editing = { element, before: element.value, inPlace };
  element.classList.add("editing");
}

function endEditing() {
  editing?.element.classList.remove("editing");
  editing = null;
}

function commit() {
  if (!editing) return;
  const { element } = editing, text = normalised(withoutUnit(element.value, element.dataset.cell));
  endEditing();
  element.value = text;
  setCell(...cellOf(element), text);
}

// Its own unit may stand behind a number.
function withoutUnit(text = "", name) {
  const { unit } = LIVE.columns[name], all = text.trim(), bare = all.slice(0, -unit.length).trim(), plain = (one) => one.replace(/[µμ]/, "u");
  return unit !== "1" && plain(all).endsWith(plain(unit)) && /[\d.)]$/.test(bare) ? bare : text;
}

function cancel() {
  editing.element.value = editing.before;
  const { element } = editing;
  endEditing();
  element.select();
}

// Alt and an arrow move an input by its last printed digit; what is being typed is entered first.
const STEPS = { ArrowUp: 1, ArrowDown: -1 };

function step(event, element) {
  handled(event);
  commit();
  setCell(...cellOf(element), stepped(element.value, STEPS[event.key]));
  if (isText(document.activeElement)) document.activeElement.select();
}

const ARROWS = { ArrowUp: [-1, 0], ArrowDown: [1, 0], ArrowLeft: [0, -1], ArrowRight: [0, 1] };

function onGridKey(event) {
  const element = event.target.closest(STOPS), text = isText(element), inPlace = editing?.element === element && editing.inPlace;
  if (event.altKey && text && STEPS[event.key]) step(event, element);
  if (!element || event.altKey || element.matches("[data-reason]")) return;
  const { key, ctrlKey, metaKey, shiftKey } = event, control = ctrlKey || metaKey, here = placeOf(element);
  const go = (place) => {
    handled(event);
    commitAndEnter(() => stopAt({ ...here, ...place }));
  };
  if (ARROWS[key] && shiftKey && !inPlace) {
    handled(event);
    if (!editing) extend(element, ARROWS[key].map((step) => step * (control ? Infinity : 1) || 0));
  } else if (ARROWS[key] && !control) {
    const [down, right] = ARROWS[key];
    if (inPlace && (right || text)) return;
    go({ row: here.row + down, stop: here.stop + right });
  } else if (ARROWS[key]) {
    const [down, right] = ARROWS[key];
    go({ row: down ? (down > 0 ? Infinity : 0) : here.row, stop: right ? (right > 0 ? Infinity : 0) : here.stop });
  } else if ((key === "Home" || key === "End") && !inPlace) {
    const last = key === "End";
    go({ row: control ? (last ? Infinity : 0) : here.row, stop: last ? Infinity : 0 });
  } else if (key === "Enter" && text) {
    go({ row: here.row + (shiftKey ? -1 : 1) });
  } else if ((key === "Tab" || event.code === "Tab") && text) { // WebKitGTK has no key for Tab with Shift
    const inputs = () => all("input[data-cell]", here.grid.tBodies[0]), index = inputs().indexOf(element) + (shiftKey ? -1 : 1);
    if (inputs()[index]) handled(event);
    commitAndEnter(() => inputs()[index]);
  } else if (key === "Escape") {
    if (editing) cancel();
    else pick();
    handled(event);
  } else if (key === "F2" && text) {
    handled(event);
    beginEditing(element, true);
    element.setSelectionRange(element.value.length, element.value.length);
  } else if (key === "Delete" && text && !editing) {
    handled(event);
    const inputs = pickedCells().flat().flatMap((cell) => all("input[data-cell]", cell));
    if (inputs.length > 1) change((state) => inputs.forEach((input) => put(state, ...cellOf(input), "")));
    else setCell(...cellOf(element), "");
    enter(element);
  }
}

function onKey(event) {
  const { key, ctrlKey, metaKey, shiftKey } = event;
  // While a text is being typed, its own steps are what is taken back.
  if ((ctrlKey || metaKey) && !editing && /^[zy]$/i.test(key) && !event.target.matches("[data-reason]")) {
    handled(event);
    if (key.toLowerCase() === "y" || shiftKey) redo();
    else undo();
    return;
  }
  if (gridOf(event.target)) onGridKey(event);
  else if ((key === "Enter" || key === " ") && event.target.matches?.("span[data-cell]")) {
    handled(event);
    showCell(...cellOf(event.target));
  }
}

// --- pointer and focus -----------------------------------------------------------------------------------

// The first press selects a cell as a whole; one more, or one while it is typed in, puts the caret into it.
function onPress(event) {
  const { target, detail, shiftKey } = event, box = boxOf(target), from = picked.from ?? boxOf(document.activeElement);
  if (shiftKey && box && from?.closest("table") === box.closest("table")) {
    handled(event);
    pick(from, box);
    return;
  }
  pick();
  picked.drag = box;
  if (isText(target)) {
    const active = target === document.activeElement;
    if (active && (editing || detail > 1)) beginEditing(target, true);
    else {
      handled(event);
      enter(target);
    }
    return;
  }
  const element = target.closest("main :is(td, span)[data-cell], td[data-published]");
  if (!element || target.closest("a")) return;
  if (!element.hasAttribute("tabindex")) element.setAttribute("tabindex", "-1");
  handled(event);
  enter(element);
}

function onFocus(event) {
  const element = event.target.closest?.("[data-cell], [data-published]");
  if (!element || element.id === "formula-bar") return;
  const grid = gridOf(element);
  if (grid && element.getAttribute("tabindex") !== "0") {
    for (const other of all("tbody [tabindex='0']", grid)) other.setAttribute("tabindex", "-1");
    element.setAttribute("tabindex", "0");
  }
  const [name, index] = cellOf(element), shown = byId("formula-bar").dataset;
  if (shown.cell !== name || shown.index !== index) showCell(name, index);
}

// --- the clipboard ---------------------------------------------------------------------------------------

function onPaste(event) {
  const element = event.target, text = (event.clipboardData?.getData("text") ?? "").replace(/[\r\n]+$/, "");
  if (!isText(element) || !/[\t\n\r]/.test(text)) return;
  handled(event);
  if (editing) cancel();
  const block = text.split(/\r\n|\r|\n/).filter((line) => line || !text.includes("\t")).map((line) => line.split("\t"));
  const commas = block.flat().some((one) => !one.includes(".") && one.includes(",") && NUMBER.test(normalised(one)));
  const read = (one = "") => normalised(one, commas), head = block.length > 1 && isHead(block[0]) && block.shift();
  const table = tableOf(element), said = (table ? pasteRows : pasteScalars)(element, block, read, head, table);
  enter(element);
  if (said) note(said);
}

const refused = (why) => `Nothing was pasted: ${why}.`;

function pasteScalars(element, rows, read) {
  if (rows.some((fields) => fields.filter(Boolean).length > 1)) return refused("here stands one number in a row");
  const names = all("input[data-cell]", gridOf(element).tBodies[0]).map((input) => input.dataset.cell), first = names.indexOf(element.dataset.cell);
  change((state) => names.slice(first, first + rows.length).forEach((name, n) => (state.parameters[name] = read(withoutUnit(rows[n].join(""), name)))));
}

// A block of texts by the names in its first line, without one from a cell on; by the numbers of rows where it has
// them, else down, into new tests. What is to be said of it: why all of it is refused, or what of it had no place.
function pasteRows({ dataset: { cell, index } }, rows, read, head, { axis, inputs, row: called }) {
  const state = copied(page.history.now), tests = state.tables[axis], before = tests.length, labels = tests.map(({ label }) => String(label)), lost = new Set();
  const file = Object.keys(LIVE.tables[axis].heads), first = rows.map(([text]) => read(text)), width = Math.max(...rows.map((fields) => fields.join("\t").trimEnd().split("\t").length));
  let names = head ? head.map((text) => columnAsked(text, inputs, LIVE.tables[axis])) : inputs.slice(inputs.indexOf(cell));
  if (!head) {
    // Rows as they stand in the file, or numbers of rows before what stands here; in which order, no head tells.
    const added = nextLabel(state, axis), news = first.filter((text) => !labels.includes(text)), wide = width > names.length;
    const numbered = wide && new Set(first).size === rows.length && news.every((text, n) => text === String(added + n));
    if (wide && !numbered) return refused(`${plural(width, "column")} for ${names.length}: copy them with their heads`);
    const whole = numbered && width === file.length && file.includes("test");
    const there = file.filter((name) => LIVE.columns[name] || (!whole && /^u\(/.test(name))), at = whole ? 0 : there.indexOf(cell);
    if ((whole ? inputs : names.slice(0, width)).some((name, n) => name !== there[at + n])) return refused(`the columns of ${LIVE.tables[axis].file} stand in another order (${there.join(", ")}): copy them with their heads`);
    if (numbered) names = whole ? file.map((name) => (name === "test" ? "" : name)) : ["", ...names];
  }
  const why = names.find((name) => name.why)?.why ?? (inputs.some((name) => names.includes(name)) ? "" : `no such column is typed here: ${head.join(", ")}`);
  if (why) return refused(why);
  const at = names.indexOf(""), numbers = at < 0 ? [] : rows.map((fields) => read(fields[at]));
  const twice = numbers.find((text, n) => text && numbers.indexOf(text) !== n);
  if (twice !== undefined) return refused(`${called} ${twice} stands twice in it`);
  let rowsLost = 0;
  for (const [down, fields] of rows.entries()) {
    const label = numbers[down] ?? index, place = labels.indexOf(label) + (at < 0 ? down : 0);
    const isNew = at < 0 ? place >= 0 : label === String(nextLabel(state, axis));
    const test = tests[place] ?? (isNew && !isGrouped(axis) ? newTest(state, axis) : null); // of no group
    if (!test) rowsLost += 1;
    for (const [n, text] of test ? fields.entries() : []) {
      const name = names[n], word = LIVE.tables[axis].texts[test.label]?.[name];
      if (inputs.includes(name)) test.cells[name] = read(withoutUnit(text, name));
      else if (word && text && read(word) !== read(text)) return refused(`${name} of ${called} ${test.label} is ${word}, not ${text}`);
      else if (!word && text && name !== "") lost.add(n);
    }
  }
  moved(page.history.push(state));
  const counts = [[rowsLost, "row"], [lost.size, "column"]].filter(([count]) => count).map((one) => plural(...one));
  return [counts[0] && `Pasted, but ${counts.join(" and ")} had no place.`, tests.length > before && ofNewRows(axis)].filter(Boolean).join(" ");
}

// The column that a name in the first line of a block is of: "" of the numbers of rows; or why it is refused.
function columnAsked(text, inputs, { heads, row }) {
  const [, name, unit] = /^(.*?)\s*(?:\[(.*)\])?$/.exec(text.trim()), own = inputs.includes(name) && LIVE.columns[name].unit;
  const plain = (one = "") => one.replace(/[µμ]/, "u").replace(/^[-1]$/, "");
  const other = own && unit !== undefined && ![own, /\[(.*)\]/.exec(heads[name])?.[1]].some((one) => plain(one) === plain(unit));
  const [, of] = /^u\((.*)\)$/.exec(name) ?? [];
  if (inputs.includes(of) && !(name in heads)) return { why: `no column ${name} is typed here: leave it out, or write u behind the number, as 46.7(5)` };
  return other ? { why: `${name} is in ${own} here, not in ${unit}` } : [row, heads.test].includes(name) ? "" : name;
}

// A first line of different words is the head of a block; what stands for a missing datum is no head.
const NO_DATUM = /^(?:nan|n\/?a|none|null|inf|infinity|true|false)$/i;

function isHead(fields) {
  const words = fields.filter(Boolean);
  return words.length > 0 && new Set(words).size === words.length && words.every((word) => /^\p{L}/u.test(word) && !NO_DATUM.test(word));
}
