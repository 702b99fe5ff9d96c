// What happens after an edit, in order: a new state, the sheet, the page. And how it all begins.

const page = {
  history: null, look: null, issued: null, tables: [], kept: [], stale: [], loose: [], places: null, marked: [], panel: null, hadMissing: false,
};

const lookAt = (state, issued) =>
  new Look(new Trace(PROGRAM, LIVE.columns, computeSheet(PROGRAM, LIVE.columns, state, LIVE.groups), LIVE.words), state, issued);

const say = (sentence) => {
  byId("live-said").textContent = sentence;
};

// What is to be read once, until something else is.
const note = (...words) => byId("live-note").replaceChildren(...words);

// --- edits -----------------------------------------------------------------------------------------------

function change(edit) {
  const state = copied(page.history.now);
  moved(edit(state) !== false && page.history.push(state));
}

// What the bar said was of the state before.
function moved(really) {
  if (!really) return;
  note();
  show();
}

function put(state, name, index, text) {
  if (index === "") state.parameters[name] = text;
  else testAt(state, axisOf(name), index).cells[name] = text;
}

function setCell(name, index, text) {
  change((state) => put(state, name, index, text));
  // At once, for the bar goes on to the next cell.
  const { trace } = page.look, row = trace.row(name, index);
  const why = trace.sheet.refused[name]?.[row] ?? (isUnknown(LIVE.columns[name], index, text) && `its u is not known: write ${text}(5) for 5 in the last digit`);
  if (why) note(`${trace.address(name, row)}: ${why}.`);
}

const enough = (state, axis) => usedTests(state, axis).length >= LIVE.tables[axis].least;

// Whether a report can do without a test; where it cannot, that is said.
function mayGo(state, { axis, row }, label) {
  const may = enough(state, axis);
  if (!may) note(`${LIVE.tables[axis].least > 1 ? `Two ${axis} are` : `One ${row} is`} the least that a report needs: ${row} ${label} stays.`);
  return may;
}

function useTest(table, label, used) {
  change((state) => {
    const test = testAt(state, table.axis, label), issued = testAt(page.history.issued, table.axis, label);
    test.used = used;
    test.reason = used ? "" : issued?.reason ?? "";
    return mayGo(state, table, label);
  });
  for (const box of all("[data-use]", table.element)) box.checked = testAt(page.history.now, table.axis, box.dataset.use).used;
}

function giveReason({ axis }, label, reason) {
  change((state) => {
    testAt(state, axis, label).reason = reason.trim();
  });
}

function removeTest(table, label) {
  change(({ tables }) => {
    tables[table.axis] = tables[table.axis].filter((test) => String(test.label) !== label);
    return mayGo({ tables }, table, label);
  });
}

// Its number is none that another had before: what was said of that one is not said of it.
const nextLabel = ({ tables }, axis) => Math.max(0, ...[...LIVE.tables[axis].rows, ...tables[axis]].map((test) => test.label)) + 1;

function newTest(state, axis) {
  const { rows } = LIVE.tables[axis], label = nextLabel(state, axis);
  const test = { label, used: true, reason: "", cells: Object.fromEntries(Object.keys(rows[0].cells).map((name) => [name, ""])) };
  state.tables[axis].push(test);
  return test;
}

// What is said of new rows where each row of the file says how sure its numbers are.
function ofNewRows(axis) {
  const names = Object.keys(LIVE.tables[axis].rows[0].cells).filter((name) => {
    const { errors, given } = LIVE.columns[name];
    return errors && !Array.isArray(errors) && !given.u;
  });
  return names.length ? `How sure ${names.join(" and ")} of a new row is, its digits tell, unless its u is written behind it, as in 46.7(5).` : "";
}

function addTest(axis) {
  change((state) => newTest(state, axis));
  const table = page.tables.find((one) => one.editable && one.axis === axis);
  const input = table.body.rows[table.body.rows.length - 1].querySelector("input[data-cell]");
  enter(input);
  if (ofNewRows(axis)) note(ofNewRows(axis));
}

const undo = () => moved(page.history.move(-1));
const redo = () => moved(page.history.move(1));

function reset() {
  hideCell();
  moved(page.history.push(copied(page.history.issued)));
}

// --- showing a state -------------------------------------------------------------------------------------

function show() {
  const begin = performance.now(), before = page.look, { now, issued } = page.history;
  const focus = document.activeElement?.closest?.("[data-cell], [data-use]");
  pick();
  page.look = lookAt(now, page.issued);
  const edited = !sameState(now, issued), wasEdited = isEdited();
  ROOT.toggleAttribute("data-edited", edited);
  // As issued, the page holds the numbers of another engine: none of them is left between ours.
  if (edited) writePage(page.look, wasEdited ? before : null);
  else restore();
  tellStale();
  keepStates(edited);
  drawSoon();
  writeToolbar(edited);
  writePanel(page.look);
  writeBar(page.look);
  if (focus && !focus.isConnected) refocus(focus);
  announce(before, page.look);
  ROOT.dataset.milliseconds = (performance.now() - begin).toFixed(2);
}

function writePage(look, last) {
  for (const table of page.tables) table.write(look, last);
  for (const element of page.loose) writeCell(element, look, element.dataset.cell, look.trace.row(element.dataset.cell, element.dataset.index));
  writeCounts(look);
  writeCounted(look);
  writeMissing(look);
  writePublished(look);
  writeUncertain(look);
  writeVerdicts(look);
  writeDecided(look);
  writeFigures(look);
}

// The page as it was issued, character by character.
function restore() {
  page.places = null;
  [...pictures.late.keys()].forEach(forget);
  for (const [element, model] of page.kept) become(element, model);
  if (!page.hadMissing) byId("missing")?.remove();
  page.loose = looseCells();
  requestAnimationFrame(letScroll);
}

// The cells outside of the tables whose rows come and go; found again when elements were replaced.
const looseCells = () => all("main [data-cell]").filter((cell) => !cell.closest("table:not(.list)"));

function refocus(element) {
  const { cell, index } = element.dataset; // rows of two tables may have one number
  const same = document.querySelector(cell ? `main [data-cell="${CSS.escape(cell)}"][data-index="${CSS.escape(index)}"]` : `[aria-label="${CSS.escape(element.ariaLabel)}"]`);
  if (same) enter(same);
}

function writeToolbar(edited) {
  const { history } = page, count = differences(history.now, history.issued);
  const differ = count === 1 ? "1 input differs" : `${count} inputs differ`;
  byId("live-banner").textContent = edited ? `Edited: ${count ? differ : `the order of the ${Object.keys(LIVE.tables).join(" or ")} differs`} from the report as issued.${lost(page.look)}` : "";
  byId("live-reset").disabled = !edited;
  byId("live-undo").disabled = history.place === 0;
  byId("live-redo").disabled = history.place === history.states.length - 1;
}

// One sentence about the result, for those who cannot see it change.
function announce(before, after) {
  const [name, index] = LIVE.headline[0] ?? [];
  if (!name) return;
  const row = after.trace.row(name, index), then = textAt(before, name, index), now = textAt(after, name, index), meaning = meaningOf(name);
  const reason = row < 0 || after.trace.isOk(name, row) ? "" : ` ${after.trace.reason(name, row)}.`;
  const broken = after.trace.errors.length;
  const cells = broken ? ` ${plural(broken, "cell")} without a value.` : "";
  say(`${meaning} (${row < 0 ? name : after.trace.address(name, row)}) ${then === now ? `is still ${now}` : `changed from ${then} to ${now}`}.${reason}${cells}`);
}

// --- the beginning ---------------------------------------------------------------------------------------

function begin() {
  unstored();
  const tables = Object.fromEntries(Object.entries(LIVE.tables).map(([axis, { rows }]) => [axis, rows]));
  page.history = new History({ tables, parameters: LIVE.parameters });
  page.look = lookAt(page.history.now, null);
  page.issued = page.look;
  prepareInputs();
  // Everything that an edit may change is kept as it is now.
  const parts = [
    ...all("main tbody"), ...all("main span[data-cell]").map((one) => one.closest("dd") ?? one), ...all("[data-count]"),
    ...all("#result > p, #published > ul > li, main .note > p, #missing"),
    ...Object.keys(LIVE.figures).map((name) => document.querySelector(`#figure-${CSS.escape(name)} .card`)).filter(Boolean),
  ];
  page.kept = parts.filter((part) => !parts.some((other) => other !== part && other.contains(part))).map((part) => [part, part.cloneNode(true)]);
  page.hadMissing = byId("missing") !== null;
  for (const figure of all("main figure")) pictures.watcher.observe(figure);
  makeAround();
  listen();
  byId("live-dock").hidden = false;
  recall();
  if (page.history.place) show();
  else {
    writeToolbar(false);
    writeBar(page.look);
  }
  toggleBar(matchMedia("(min-width: 48rem)").matches);
  new ResizeObserver(makeRoom).observe(byId("live-dock"));
  // A frame later, or sizes would change under the observer; only for another width, for to ask lays out what was put off.
  let wide = 0;
  new ResizeObserver(() => requestAnimationFrame(() => {
    placePanel();
    if (wide !== (wide = byId("main").clientWidth)) letScroll();
  })).observe(byId("main"));
  ROOT.dataset.live = "ready";
}

// What has the focus must not hide behind the bar, nor the end of the page.
function makeRoom([entry]) {
  const height = `${Math.ceil(entry.borderBoxSize[0].blockSize) + 12}px`;
  document.body.style.paddingBottom = height;
  ROOT.style.scrollPaddingBottom = height;
}

// Equations and pictures that are wider than the page are scrolled with the keyboard, too.
function letScroll() {
  const boxes = all("main .eq .scroll, article div, main .card");
  const wide = boxes.map((box) => box.scrollWidth > box.clientWidth || box.scrollHeight > box.clientHeight);
  boxes.forEach((box, n) => (wide[n] ? box.setAttribute("tabindex", "0") : box.removeAttribute("tabindex")));
}

function prepareInputs() {
  for (const input of all("main input[data-cell]")) {
    input.removeAttribute("readonly");
    for (const [name, value] of Object.entries(INPUT_ATTRIBUTES)) input.setAttribute(name, value);
  }
  const tables = all("main table:not(.list)").filter((table) => table.querySelector("tbody [data-cell]"));
  page.tables = tables.map((table) => new Table(table));
  for (const name of Object.keys(LIVE.tables)) page.tables.find(({ axis, inputs }) => axis === name && inputs.length)?.makeEditable();
  page.loose = looseCells();
  for (const cell of page.loose) {
    if (cell.tagName === "SPAN") furnished(cell, { tabindex: "0", role: "button", "aria-controls": "formula-bar" }, []);
  }
  for (const { id, rows } of LIVE.published) {
    rows.forEach(([cell, index], place) => (byId(id).querySelector("tbody").rows[place].cells[3].dataset.published = `${cell} ${index}`));
  }
  makeGrids();
}

function listen() {
  const main = byId("main");
  document.addEventListener("keydown", onKey);
  document.addEventListener("focusin", onFocus);
  document.addEventListener("copy", onCopy);
  main.addEventListener("mousedown", onPress);
  main.addEventListener("paste", onPaste);
  main.addEventListener("beforeinput", (event) => isText(event.target) && beginEditing(event.target, false));
  main.addEventListener("focusout", (event) => editing?.element === event.target && commit());
  main.addEventListener("mousemove", onDrag);
  main.addEventListener("change", ({ target }) => {
    const { use, reason } = target.dataset, table = tableOf(target);
    if (use) useTest(table, use, target.checked);
    if (reason) giveReason(table, reason, target.value);
  });
  // A button of the bar leaves the focus where it is: what is being typed is entered by the click, not before
  // it, or the bar would grow and take the button from under the pointer.
  byId("live-dock").addEventListener("mousedown", (event) => event.target.closest("button") && handled(event));
  addEventListener("beforeunload", onLeave);
  addEventListener("storage", followOther);
  addEventListener("hashchange", () => followLink() && show());
  document.addEventListener("click", (event) => {
    const button = event.target.closest?.("button");
    if (button) pressed(button);
  });
}

function pressed(button) {
  commit();
  const actions = { "live-undo": undo, "live-redo": redo, "live-reset": reset, "live-save": save, "live-link": shareLink };
  if (button.dataset.goto) goTo(button.dataset.goto);
  else if (button.matches("[data-copy]")) copyTable(button.parentElement.querySelector("table"));
  else if (button.dataset.remove) removeTest(tableOf(button), button.dataset.remove);
  else if (button.dataset.add) addTest(button.dataset.add);
  else if (button.id === "bar-toggle") toggleBar(!bar.open);
  else actions[button.id]?.();
}

begin();
