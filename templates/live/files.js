// The edited input as the files it came from: a build of them gives the numbers that the page shows.

// Everything but plain words is quoted: a comma in it is none between fields.
const csvField = (text) => (/^[\w.+\- [\]/()^*%°µμ²³⁻]*$/.test(text) ? text : `"${text.replaceAll('"', '""')}"`);

// What stands in the column of tests that are left out.
const leftOut = ({ used, reason }) => (used ? "" : reason || "no reason was given");

function measurementsCsv(state, axis) {
  const tests = savedTests(state, axis), heads = { ...LIVE.tables[axis].heads };
  if (tests.some(({ used }) => !used)) heads["left out"] ??= "left out";
  for (const name of retyped(state)) {
    if (axisOf(name) === axis) for (const head of [name, `u(${name})`]) heads[head] = `${head} [${LIVE.columns[name].given.taken}]`;
  }
  const lines = tests.map((test) => Object.keys(heads).map((name) => savedField(axis, test, name)));
  return [Object.values(heads), ...lines].map((fields) => fields.map(csvField).join(",") + "\n").join("");
}

// What stands in a row in the column of this name: what was not edited as it stood.
function savedField(axis, test, name) {
  const { label, cells } = test, was = LIVE.tables[axis].texts[label]?.[name], of = /^u\((.*)\)$/.exec(name)?.[1];
  if (name === "test") return String(label);
  if (name === "left out") return leftOut(test);
  if (cells[of] === "" && issuedCell(axis, label, of)) return "";
  if (!(name in cells)) return was || (of in cells ? uncertaintyOf(LIVE.columns[of], label, cells[of]) : wordOf(axis, label, name));
  const issued = issuedCell(axis, label, name), { given } = LIVE.columns[name];
  // What was typed with its uncertainty: that stands in its own column.
  if (given.u && !readInput(LIVE.columns[name], label, cells[name]).why) return cells[name].replace(CONCISE, "$1");
  return was && was !== issued ? (cells[name] === issued ? was : withStated(cells[name], CONCISE.exec(was))) : cells[name];
}

// What stands beside a row in a column of words: a row that was added has a name where all others have one, because a
// build tells the names only of tables in which none is missing.
function wordOf(axis, label, name) {
  const { texts, naming, row } = LIVE.tables[axis];
  return texts[label]?.[name] ?? (naming.includes(name) ? `${row} ${label}` : "");
}

// A number with the uncertainty that another text has in parentheses, and as many digits as say it.
function withStated(text, [, other, u]) {
  if (!NUMBER.test(text)) return text;
  const places = Math.max(0, decimalsOf(text), decimalsOf(other));
  return `${fixedExact(readExact(text), places)}(${u}${"0".repeat(places - decimalsOf(other))})`;
}

// An empty row is dropped. What was issued stays, for published values may be about it: as a test left out, and at its
// place, by which rows without numbers are counted.
function savedTests(state, axis) {
  const saved = state.tables[axis].filter(({ cells }) => Object.values(cells).some(Boolean));
  const at = (label) => saved.findIndex((test) => test.label === label);
  const why = ({ label }) => (testAt(state, axis, label) ? "its numbers were deleted" : "removed");
  page.history.issued.tables[axis].forEach((test, n, { [n - 1]: before }) => {
    if (at(test.label) < 0) saved.splice(before ? at(before.label) + 1 : 0, 0, { ...test, used: false, reason: test.reason || why(test) });
  });
  return saved;
}

// Those that take part, of every table.
const savedUsed = (state) => Object.keys(state.tables).flatMap((axis) => savedTests(state, axis).filter(({ used }) => used).map((test) => ({ axis, ...test })));

// What a build of the files is made from.
const asBuilt = (state) => JSON.stringify([savedUsed(state), state.parameters]);

// The inputs that a build of the files would refuse.
function refusedInputs(state) {
  const tests = savedUsed(state), empty = (name) => tests.every(({ cells }) => !cells[name]);
  const refused = (cells, index) => Object.keys(cells).filter((name) => (cells[name] || !index || empty(name)) && readInput(LIVE.columns[name], index, cells[name]).why);
  const measured = tests.flatMap(({ label, cells }) => refused(cells, label).map((name) => `${name}[${label}]`));
  return [...measured, ...refused(state.parameters, "")];
}

// Numbers of a column of which the one beside it, which states uncertainties, says nothing.
const unsure = (state) => savedUsed(state).flatMap(({ axis, label, cells }) => Object.keys(cells).filter((name) => isUnknown(LIVE.columns[name], label, cells[name])).map((name) => `u(${name}) of ${LIVE.tables[axis].row} ${label}`));

// What stands for the uncertainty of a number where a column has it: what is stated of it, in the unit of that column.
function uncertaintyOf(column, label, text) {
  const sizes = isUnknown(column, label, text) ? [] : errorsOf(column, label, text).map(({ u }) => u);
  return sizes.length ? brief((Math.hypot(...sizes) / column.scale) * column.given.u) : "";
}

const issuedCell = (axis, label, name) => testAt(page.history.issued, axis, label)?.cells[name];

// What came from another report and has other numbers now: all of it is saved as what was typed.
function retyped(state) {
  const { parameters } = page.history.issued;
  const edited = (name) => state.parameters[name] !== parameters[name] || savedUsed(state).some(({ axis, label, cells }) => cells[name] !== issuedCell(axis, label, name));
  return Object.keys(LIVE.columns).filter((name) => LIVE.columns[name].given?.taken && edited(name));
}

function reportToml(state) {
  const own = retyped(state);
  return LIVE.toml.map((piece) => {
    if (typeof piece === "string") return piece;
    if (piece.file) return piece.file;
    if (piece.taken) return own.includes(piece.taken) ? "# " : "";
    const text = JSON.stringify(state.parameters[piece.parameter]).slice(1, -1);
    const same = state.parameters[piece.parameter] === page.history.issued.parameters[piece.parameter];
    if (piece.was) return same ? piece.was : piece.behind;
    if (!piece.line) return text;
    return same ? "" : `${piece.line} = "${text}${piece.behind}"\n`;
  }).join("");
}

// All files that a build needs.
function save() {
  const { now } = page.history, files = Object.fromEntries(Object.keys(LIVE.tables).map((axis) => [LIVE.tables[axis].file, measurementsCsv(now, axis)]));
  Object.assign(files, { "report.toml": reportToml(now), ...LIVE.files });
  for (const link of all("#live-note a[download]")) URL.revokeObjectURL(link.href);
  const links = Object.entries(files).map(([name, text]) => {
    const url = URL.createObjectURL(new Blob([text], { type: "text/plain;charset=utf-8" }));
    return make("a", { href: url, download: name }, name);
  });
  const refused = refusedInputs(now), until = refused.length ? `. No build takes them before this is a number that is allowed: ${refused.join(", ")}.` : "";
  const open = unsure(now), empty = open.length ? ` To be filled before a build: ${open.join(", ")}.` : "";
  const own = retyped(now), apart = own.length ? ` No longer taken from another report, nor are shared errors: ${own.join(", ")}.` : "";
  note("Saved: ", ...links.flatMap((link, n) => (n ? [" ", link] : [link])), until, empty, apart);
  // WebKit drops a download that has not begun when the next one is asked for.
  links.forEach((link, n) => setTimeout(() => link.click(), 500 * n));
  lasting.safe = now;
  say(`Saved ${Object.keys(files).join(", ")}.`);
}
