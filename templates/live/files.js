// The edited input as the files it came from: a build of them gives the numbers that the page shows.

// Everything but plain words is quoted, so that a program that opens tables runs nothing.
const csvField = (text) => (/^[\w.+\- [\]/()^*%°µμ²³⁻]*$/.test(text) ? text : `"${text.replaceAll('"', '""')}"`);

// What stands in the column of tests that are left out.
const leftOut = ({ used, reason }) => (used ? "" : reason || "no reason was given");

function measurementsCsv(state) {
  const names = Object.keys(LIVE.units), given = Object.keys(LIVE.uncertainties);
  const heads = names.flatMap((name) => {
    const unit = `[${LIVE.units[name]}]`;
    return given.includes(name) ? [`${name} ${unit}`, `u(${name}) ${unit}`] : [`${name} ${unit}`];
  });
  const tests = savedTests(state), someOut = tests.some(({ used }) => !used);
  const lines = tests.map((test) => {
    const { label, cells } = test;
    const fields = names.flatMap((name) => {
      const known = LIVE.uncertainties[name];
      return known ? [cells[name], known[label] ?? lastDigitUncertainty(cells[name])] : [cells[name]];
    });
    return [String(label), ...fields, ...(someOut ? [leftOut(test)] : [])];
  });
  if (someOut) heads.push("left out");
  return [["test", ...heads], ...lines].map((fields) => fields.map(csvField).join(",") + "\n").join("");
}

// An empty row is dropped. What was issued stays, for published values may be about it: as a test left out.
function savedTests(state) {
  const full = state.tests.filter(({ cells }) => Object.values(cells).some(Boolean)), labels = full.map(({ label }) => label);
  const gone = page.history.issued.tests.filter(({ label }) => !labels.includes(label));
  const why = ({ label }) => (state.tests.some((test) => test.label === label) ? "its numbers were deleted" : "removed");
  return [...full, ...gone.map((test) => ({ ...test, used: false, reason: test.reason || why(test) }))];
}

// The inputs that a build of the files would refuse.
function refusedInputs(state) {
  const refused = (name, text) => readInput(LIVE.columns[name].given, text).why;
  const measured = savedTests(state).filter(({ used }) => used).flatMap(({ label, cells }) =>
    Object.keys(cells).filter((name) => refused(name, cells[name])).map((name) => `${name}[${label}]`));
  return [...measured, ...Object.keys(state.parameters).filter((name) => refused(name, state.parameters[name]))];
}

// What stands for the uncertainty of a number that came without one: half a unit of its last digit, rectangular.
function lastDigitUncertainty(text) {
  return NUMBER.test(text) ? brief(10 ** -decimalsOf(text) / 2 / Math.sqrt(3)) : "";
}

function reportToml(state) {
  return LIVE.toml.map((piece) => {
    if (typeof piece === "string") return piece;
    if (piece.file) return piece.file;
    const text = JSON.stringify(state.parameters[piece.parameter]).slice(1, -1);
    if (!piece.line) return text;
    const same = state.parameters[piece.parameter] === page.history.issued.parameters[piece.parameter];
    return same ? "" : `${piece.parameter} = "${text}${piece.unit ? ` ${piece.unit}` : ""}"\n`;
  }).join("");
}

// All files that a build needs.
function save() {
  const { now } = page.history, files = { [LIVE.file]: measurementsCsv(now), "report.toml": reportToml(now), ...LIVE.files };
  for (const link of all("#live-note a[download]")) URL.revokeObjectURL(link.href);
  const links = Object.entries(files).map(([name, text]) => {
    const url = URL.createObjectURL(new Blob([text], { type: "text/plain;charset=utf-8" }));
    return make("a", { href: url, download: name }, name);
  });
  const refused = refusedInputs(now), until = refused.length ? `. No build takes them before this is a number that is allowed: ${refused.join(", ")}.` : "";
  note("Saved: ", ...links.flatMap((link, n) => (n ? [" ", link] : [link])), until);
  // WebKit drops a download that has not begun when the next one is asked for.
  links.forEach((link, n) => setTimeout(() => link.click(), 500 * n));
  lasting.safe = now;
  say(`Saved ${Object.keys(files).join(", ")}.`);
}
