"use strict";
// The live page: the report that can be edited. Read first; the files that follow share one scope.
//
// What other programs (and tests) may hold on to:
//   html[data-live="ready"]           the script has started; before, the page is the report as issued
//   html[data-edited]                 the inputs differ from those that were issued
//   [data-cell][data-index]           a cell; data-value in SI (as Python prints it), data-status
//   input[data-cell]                  an input: its value is the printed string, in the unit of its header
//   .changed, .added                  it differs from the report as issued; it was not in it
//   .precedent, .selected             what the cell in the formula bar rests on; that cell
//   tr[data-label="2"]                a row of a table; .excluded: a test that is left out
//   input[data-use="2"]               takes a test in or out; button[data-remove="2"]; #live-add
//   input[data-reason="2"]            why a test is left out
//   [aria-selected]                   a cell that Ctrl+C copies; .table > button[data-copy] copies all of a table
//   #live-undo #live-redo #live-reset #live-save #live-link
//   #live-banner (role=status), #live-said (aria-live), #live-note (role=status): what happened to the edits
//   #live-note a[download]            the files of the last save; #live-note a: the link that was copied
//   #live-panel                       the result beside the table that is edited, as issued and now
//   [data-issued] > .stale            a chapter that is as issued
//   #formula-bar[data-cell][data-index]; #bar-toggle (aria-expanded)
//   #bar-name #bar-meaning #bar-value #bar-reason #bar-sure #bar-draws #bar-source #bar-equation #bar-put
//   #bar-draws[data-u][data-ends][data-lost]          what draws told, in SI; #live-panel span: of the results
//   #bar-precedents button[data-goto="x_p[2]"], #bar-dependents button[data-goto]
//   #figure-loops svg, #figure-alpha_pairs svg      drawn again (then of the class picture)
//   [aria-busy]                       a picture that is not seen, until it is drawn again
//   #why-NAME-INDEX                   the row that says why a cell has no value
//   html[data-milliseconds]           how long the last recalculation and redrawing took

const byId = (id) => document.getElementById(id);
const ROOT = document.documentElement;
const handled = (event) => event.preventDefault();
const isEdited = () => ROOT.hasAttribute("data-edited");
const all = (selector, within = document) => Array.from(within.querySelectorAll(selector));
const LIVE = JSON.parse(byId("live-data").textContent);
LIVE.columns = wholeColumns(LIVE.columns);
const SVG = "http://www.w3.org/2000/svg", MATHML = "http://www.w3.org/1998/Math/MathML";

// An element with attributes and children; text stays text, whatever is in it.
function make(tag, attributes = {}, ...children) {
  return furnished(document.createElement(tag), attributes, children);
}

const draw = (tag, attributes = {}, ...children) =>
  furnished(document.createElementNS(SVG, tag), attributes, children);

function furnished(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value !== null && value !== undefined && value !== false) element.setAttribute(name, value === true ? "" : value);
  }
  element.append(...children);
  return element;
}

// Writes a text where it differs: what is left alone needs no new layout.
function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

const slug = (label) => label.replace(/[^\w.]+/g, "-").replace(/^-+|-+$/g, "") || "x";
const cellId = (kind, name, index) => slug(index ? `${kind}-${name}-${index}` : `${kind}-${name}`);
const plural = (count, word) => `${count} ${word}${count === 1 ? "" : "s"}`;

const PARTS = { symbol: "i", meaning: "b", unit: "u", equation: "s" };

// A copy of what the report says of a column, in its own markup.
function part(name, what) {
  const found = byId("live-parts").content.querySelector(`[data-of="${CSS.escape(name)}"] > ${PARTS[what]}`);
  return found ? Array.from(found.cloneNode(true).childNodes) : [];
}

// Its unit, as it stands behind a number.
const behind = (name) => (LIVE.columns[name].unit === "1" ? [] : ["\u00a0", ...part(name, "unit")]);

const meaningOf = (name) => part(name, "meaning").map((node) => node.textContent).join("");

// Makes an element what another one is, keeping every element that stays, for one may have the focus.
function become(element, model) {
  // In their order, too: a row that a new test brought has them as the script writes them.
  const names = (one) => Array.from(one.attributes, ({ name }) => name);
  if (String(names(element)) !== String(names(model))) names(element).forEach((name) => element.removeAttribute(name));
  for (const { name, value } of Array.from(model.attributes)) {
    if (element.getAttribute(name) !== value) element.setAttribute(name, value);
  }
  if (element.type === "checkbox") element.checked = element.defaultChecked;
  else if (element.tagName === "INPUT") element.value = element.defaultValue;
  const old = Array.from(element.childNodes), wanted = Array.from(model.childNodes);
  const alike = old.length === wanted.length && old.every((node, n) => node.nodeName === wanted[n].nodeName);
  if (!alike) element.replaceChildren(...wanted.map((node) => node.cloneNode(true)));
  else {
    old.forEach((node, n) => {
      if (node.nodeType === Node.ELEMENT_NODE) become(node, wanted[n]);
      else if (node.data !== wanted[n].data) node.data = wanted[n].data;
    });
  }
}
