// Cells of a table are selected and copied as in a spreadsheet: a rectangle between two of them, as text with
// tabs and as HTML, numbers as every program reads them.

const picked = { from: null, to: null, drag: null }; // two cells of one table; where the pointer went down
const copying = { what: null }; // what a button puts on the clipboard

const boxOf = (element) => element?.closest?.("table[role=grid] tbody :is(td, th):not(.tools)");

// The cells between the two, row by row.
function pickedCells() {
  if (!picked.from?.isConnected || !picked.to?.isConnected) return [];
  const [top, bottom] = ordered(picked.from.parentElement.rowIndex, picked.to.parentElement.rowIndex);
  const [left, right] = ordered(picked.from.cellIndex, picked.to.cellIndex);
  const rows = Array.from(picked.from.closest("table").rows).slice(top, bottom + 1);
  return rows.map((row) => Array.from(row.cells).slice(left, right + 1).filter((cell) => cell.className !== "tools"));
}

const ordered = (a, b) => (a < b ? [a, b] : [b, a]);

// Without cells nothing is selected any more; one is selected by having the focus.
function pick(from = null, to = from) {
  for (const cell of all("[aria-selected]")) cell.removeAttribute("aria-selected");
  [picked.from, picked.to] = [from, to];
  if (from === to) return;
  for (const cell of pickedCells().flat()) cell.setAttribute("aria-selected", "true");
}

// One more row or column; the focus stays where it was.
function extend(element, [down, right]) {
  const from = picked.from?.isConnected && picked.from.contains(element) ? picked.from : boxOf(element);
  const to = picked.from === from && picked.to?.isConnected ? picked.to : from, rows = to.closest("tbody").rows;
  const row = rows[Math.max(0, Math.min(to.parentElement.sectionRowIndex + down, rows.length - 1))];
  const next = boxOf(row.cells[Math.max(0, Math.min(to.cellIndex + right, row.cells.length - 1))]) ?? to;
  next.scrollIntoView({ block: "nearest", inline: "nearest" });
  pick(from, next);
}

function onDrag({ target, buttons }) {
  const box = boxOf(target);
  if (!buttons || !picked.drag) picked.drag = null;
  else if (box && box.closest("table") === picked.drag.closest("table") && (box !== picked.drag || picked.to !== picked.from)) {
    if (editing) return;
    document.getSelection().removeAllRanges();
    pick(picked.drag, box);
  }
}

// --- what is copied ----------------------------------------------------------------------------------------

const LOWERED = Object.fromEntries([...`${RAISED}⁻`].map((sign, digit) => [sign, digit > 9 ? "-" : String(digit)]));

// A number as it is shown, for programs: 1.019 × 10⁹ is 1.019e9.
function plainNumber(text) {
  const plain = text.replaceAll(MINUS, "-").replaceAll(THIN, "");
  return plain.replace(/\u00a0×\u00a010([⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+)/, (_, power) => `e${[...power].map((sign) => LOWERED[sign]).join("")}`);
}

function cellText(cell) {
  const input = cell.querySelector("input[data-cell]");
  if (input) return input.value;
  if (cell.className === "tools") {
    const test = testAt(page.history.now, tableOf(cell).axis, cell.parentElement.dataset.label);
    return test ? leftOut(test) : "left out";
  }
  // A head says what the column is called in a file; a list of different quantities has none.
  const below = cell.closest("thead") && cell.closest("table:not(.list)")?.tBodies[0].rows[0]?.cells[cell.cellIndex];
  const name = below && (below.querySelector("input[data-cell]") ?? below).dataset.cell;
  return name ? `${name} [${LIVE.columns[name].unit}]` : plainNumber(cell.textContent.trim().replace(/[ \n\t]+/g, " "));
}

// What begins as a formula and is no number gets an apostrophe, which says to programs that it is a text.
function asTable(rows) {
  const texts = rows.map((cells) => cells.map((cell) => cellText(cell).replace(/^[=+@-](?![\d.]+(e[+-]?\d+)?(\(\d+\))?$)/i, "'$&")));
  const lines = texts.map((cells) => make("tr", {}, ...cells.map((text) => make("td", {}, text))));
  return { plain: texts.map((cells) => cells.join("\t")).join("\n"), html: asMarkup(make("table", {}, ...lines)) };
}

const asMarkup = (element) => new XMLSerializer().serializeToString(element);

function copyTable(table) {
  const all = table.querySelector(".excluded"); // a test that is left out takes its reason along
  const rows = Array.from(table.rows, (row) => Array.from(row.cells).filter((cell) => all || cell.className !== "tools"));
  copyText(asTable(rows));
  say(`Copied ${plural(rows.length, "row")}.`);
}

// The page may write to the clipboard while it handles a copy, in every browser.
function copyText(what) {
  copying.what = what;
  document.execCommand("copy");
  copying.what = null;
}

function onCopy(event) {
  let { what } = copying;
  const { activeElement: focus } = document, cells = pickedCells();
  if (!what && !editing && cells.flat().length > 1) what = asTable(cells);
  // One cell; of an input, and of words that were marked, the browser copies what is marked.
  if (!what && !isText(focus) && document.getSelection().isCollapsed && boxOf(focus)) what = asTable([[boxOf(focus)]]);
  if (!what) return;
  event.clipboardData.setData("text/plain", what.plain);
  event.clipboardData.setData("text/html", what.html);
  handled(event);
}
