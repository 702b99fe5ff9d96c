// The formula bar: what a number is, where it comes from, and what is computed from it.

const bar = { name: "", index: "", open: true, hint: byId("bar-hint").textContent };
const MOST_BUTTONS = 12, MOST_SOURCES = 6;

function showCell(name, index) {
  if (!LIVE.columns[name]) return;
  bar.name = name;
  bar.index = index;
  drawSoon();
  writeBar(page.look);
}

function hideCell() {
  bar.name = "";
  writeBar(page.look);
}

function writeBar(look) {
  const box = byId("formula-bar"), { name, index } = bar, row = look.trace.row(name, index);
  box.dataset.cell = name;
  box.dataset.index = index;
  byId("bar-hint").hidden = row >= 0;
  byId("bar-cell").hidden = row < 0;
  for (const id of ["reason", "sure", "draws", "source", "put", "precedents", "dependents"]) byId(`bar-${id}`).hidden = true;
  byId("bar-hint").textContent = !name ? bar.hint : row >= 0 ? "" : `${name}[${index}] has no place in the sheet now: its ${beneath(look.trace.declared[name].axis)?.row} is left out or removed.`;
  if (row >= 0) fillBar(look, name, row, index);
  markCells(look, name, row, index);
}

function fillBar(look, name, row, index) {
  const { trace } = look, column = LIVE.columns[name], here = trace.declared[name];
  byId("bar-name").replaceChildren(...part(name, "symbol"), make("code", {}, trace.address(name, row)));
  byId("bar-meaning").replaceChildren(...part(name, "meaning"));
  byId("bar-value").replaceChildren(...fullValue(look, name, row));
  if (!trace.isOk(name, row)) {
    const origin = trace.culprit(name, row), itself = origin.name === name && origin.row === row;
    fillLine("bar-reason", itself ? "" : "needs ", ...(itself ? [] : [cellButton(look, origin.name, origin.row), ": "]), trace.why(origin.name, origin.row));
  }
  fillSure(look, name, row);
  fillDraws(look);
  if (column.given) fillLine("bar-source", `given, ${here.axis === null ? "in report.toml" : `in ${LIVE.tables[here.axis].file}, ${LIVE.tables[here.axis].row} ${index}`}`);
  else fillLine("bar-source", ...sourceLine(column), ...publishedMath(column, name, row));
  if (column.put && trace.isOk(name, row)) fillLine("bar-put", ...putIn(look, name, row));
  const others = (groups) => groups.filter((one) => one.name !== name); // what is iterated names itself
  fillCells(look, "bar-precedents", "rests on", others(trace.precedents(name, row)));
  fillCells(look, "bar-dependents", "used by", others(trace.dependents(name, row)));
}

// Its uncertainty and what most of it comes from.
function fillSure(look, name, row) {
  const known = sureOf(look, name, row), { kept, bent } = LIVE.columns[name], doubt = doubtOf(look, name, row);
  if (!known) {
    const lacking = LIVE.shared && look.sure.lacking(name, row), waits = LIVE.shared && look.sure.more[[name, row]] === undefined, second = waits && bent?.[look.trace.index(name, row)] && `its uncertainty is of second order${carlo.refused ? ", which this browser leaves to a build" : " …"}`;
    const told = lacking ? `its uncertainty is ${lacking}` : LIVE.shared ? second : kept && "its uncertainty is as issued";
    if (told && look.trace.isOk(name, row)) fillLine("bar-sure", make("span", { class: "says" }, told));
    return;
  }
  const [, u, factor, expanded] = known.texts, second = known.second ? [make("span", {}, `second order ${percent(known.second)}`)] : [];
  const from = estimates(look, known.from).slice(0, MOST_SOURCES).map(({ called, rows, share, goto }) => {
    const bar = make("i", { class: "share" });
    bar.style.width = `${Math.round(60 * Math.abs(share))}px`;
    return make(goto ? "button" : "span", { type: goto && "button", "data-goto": goto }, make("code", {}, called), `${rows} ${percent(share)} `, bar);
  });
  const wide = expanded ? [`, U = ${expanded}`, ...behind(name), ` with k = ${factor} for 95\u00a0%`, doubt ? `; ${doubt}` : ""] : [];
  fillLine("bar-sure", make("span", { class: "says" }, "known to"), `u = ${u}`, ...behind(name), ...wide, ...from, ...second);
}

function fillLine(id, ...nodes) {
  byId(id).replaceChildren(...nodes);
  byId(id).hidden = false;
}

// All digits, in the unit of the report; a given number as it was printed.
function fullValue(look, name, row) {
  const { scale, zero, given } = LIVE.columns[name], { texts } = look.column(name);
  if (!look.trace.isOk(name, row)) return [make("span", { class: "error" }, CODES[look.trace.sheet.status[name][row]])];
  const text = given ? texts[row] : repr((look.trace.sheet.value[name][row] - zero) / scale).replace(/\.0$/, "");
  const [mantissa, power] = text.split("e");
  const shown = (power === undefined || given ? text : `${mantissa} × 10${raised(Number(power))}`).replace("-", MINUS);
  return [shown, ...behind(name)];
}

// The articles of the equations, by number: where what is known of them stands.
const CLAIMS = Object.fromEntries(all("article").map((claim) => [claim.querySelector("b").textContent, claim]));

// The numbers of its equations in the ledger; mostly there is one.
const equationsOf = ({ equations, source }) => equations ?? (CLAIMS[source] ? [source] : []);

function sourceLine(column) {
  const equations = equationsOf(column);
  if (!equations.length) return [`from ${column.source}`];
  return equations.flatMap((label, place) => {
    const claim = CLAIMS[label], link = make("a", { href: `#${claim.id}`, class: "eqref" }, label);
    return [place ? ", solved as " : "from ", link, " ", claim.querySelector("small").cloneNode(true)];
  });
}

// The equation as the report prints it: a copy from its place there.
function publishedMath(column, name, row) {
  const [label] = equationsOf(column), found = label && CLAIMS[label].querySelector("div > math");
  if (!found) return [];
  const copy = found.cloneNode(true);
  const rows = LIVE.columns[name].put ? "" : summedRows(name, row);
  return [make("span", { class: "math" }, copy), rows];
}

// Over how many rows a sum runs, all or those of a group: its terms are too many to be put in.
function summedRows(name, row) {
  const { declared, sheet } = page.look.trace;
  return declared[name].sums.map((axis) => {
    const number = sheet.kept[name].keep[axis].slice(...summed(sheet.layouts[axis], row)).filter(Boolean).length;
    return ` over ${number}\u00a0${rowsOf(axis)}`;
  }).join(",");
}

// What the rows of an index set are called, those of groups once more as themselves.
function rowsOf(axis) {
  const { of, kind } = axisNamed(axis);
  return kind === "members" ? of : axis;
}

// The equation with the values put in, in SI.
function putIn(look, name, row) {
  const { trace } = look, { put, none } = LIVE.columns[name], [math] = part(name, "equation"), cells = put.split(",");
  const axis = trace.declared[name].axis, layout = axis === null ? null : trace.sheet.layouts[axis];
  const valueOf = ([of, index = null]) => {
    if (of === "") return trace.sheet.layouts[index].size;
    if (of === "#") return layout.ordinals[index][row];
    return trace.sheet.value[of][index === null ? 0 : layout.rows[index][row]];
  };
  for (const place of all("ms", math)) place.replaceWith(...numberMath(valueOf(cells[place.textContent].split(" "))));
  math.setAttribute("display", "block");
  const shown = make("span", { class: "math" }, ...breakable(math));
  if (none !== undefined) return [make("span", { class: "si" }, "in SI: "), shown];
  const value = numberMath(trace.sheet.value[name][row]).map((node) => node.textContent).join("").replace(/^\((.*)\)$/, "$1");
  return [make("span", { class: "si" }, "in SI: "), ...part(name, "symbol"), " = ", shown, ` = ${value}`];
}

// A formula in pieces, each but the first beginning with an operator: a line may end between them.
function breakable(math) {
  const row = math.childElementCount === 1 && math.firstChild.localName === "mrow" ? math.firstChild : math, pieces = [];
  for (const node of Array.from(row.childNodes)) {
    const operator = node.localName === "mo" && "+\u2212·=".includes(node.textContent);
    if (pieces.length && operator) node.setAttribute("form", "infix"); // the first of a row would be a prefix
    if (!pieces.length || operator) pieces.push(math.cloneNode(false));
    pieces.at(-1).append(node);
  }
  return pieces;
}

// A number for a formula: six digits, in parentheses where it would not hold together.
function numberMath(value) {
  const [mantissa, power] = brief(value).split("e");
  const text = mantissa.replace("-", MINUS) + (power === undefined ? "" : `\u202f×\u202f10${raised(Number(power))}`);
  const element = (tag, attributes, ...content) => furnished(document.createElementNS(MATHML, tag), attributes, content);
  const number = element("mn", {}, text), close = { stretchy: "false", lspace: "0", rspace: "0" };
  if (power === undefined && value >= 0) return [number];
  return [element("mrow", {}, element("mo", close, "("), number, element("mo", close, ")"))];
}

// --- precedents and dependents ---------------------------------------------------------------------------

function cellButton(look, name, row) {
  const address = look.trace.address(name, row), shown = look.shownText(name, row);
  return make("button", { type: "button", "data-goto": address, title: meaningOf(name) }, make("code", {}, address), ` ${shown}`);
}

function fillCells(look, id, says, groups) {
  const seen = new Set(), nodes = [];
  for (const { name, rows } of groups) {
    const fresh = rows.filter((row) => !seen.has(`${name} ${row}`));
    fresh.forEach((row) => seen.add(`${name} ${row}`));
    if (fresh.length <= MOST_BUTTONS) nodes.push(...fresh.map((row) => cellButton(look, name, row)));
    else nodes.push(make("span", { class: "many" }, make("code", {}, name), ` ${fresh.length} rows`));
  }
  if (nodes.length) fillLine(id, make("span", { class: "says" }, says), ...nodes);
}

// Where each cell stands in the page.
function placesOf(name, index) {
  if (!page.places) {
    page.places = new Map();
    for (const element of all("main [data-cell]")) {
      const address = `${element.dataset.cell} ${element.dataset.index}`, found = page.places.get(address);
      if (found) found.push(element);
      else page.places.set(address, [element]);
    }
  }
  return page.places.get(`${name} ${index}`) ?? [];
}

function markCells(look, name, row, index) {
  const wanted = new Map();
  if (row >= 0) {
    for (const { name: other, rows } of look.trace.precedents(name, row)) {
      if (!placesOf(other, look.trace.index(other, rows[0])).length) continue;
      for (const one of rows) {
        for (const element of placesOf(other, look.trace.index(other, one))) wanted.set(element, "precedent");
      }
    }
    for (const element of placesOf(name, index)) wanted.set(element, "selected");
  }
  for (const [element, word] of page.marked) if (wanted.get(element) !== word) element.classList.remove(word);
  for (const [element, word] of wanted) element.classList.add(word);
  page.marked = wanted;
}

// Goes to a cell: to its place in a table if it has one.
function goTo(address) {
  const { trace } = page.look, [, name, called = ""] = ADDRESS.exec(address), row = trace.row(name, called), index = row < 0 ? called : trace.index(name, row);
  const selector = `main [data-cell="${CSS.escape(name)}"][data-index="${CSS.escape(index)}"]`;
  const element = byId(cellId("cell", name, index)) ?? document.querySelector(selector);
  if (!element) {
    showCell(name, index);
    return;
  }
  element.scrollIntoView({ block: "center", behavior: "instant" });
  enter(element);
}

function toggleBar(open) {
  bar.open = open;
  byId("bar-body").hidden = !open;
  byId("bar-toggle").setAttribute("aria-expanded", String(open));
}
