// The edited input as the files it came from: a build of them gives the numbers that the page shows.

// Everything but plain words is quoted, so that a program that opens tables runs nothing.
const csvField = (text) => (/^[\w.+\- [\]/()^*%°µμ²³⁻]*$/.test(text) ? text : `"${text.replaceAll('"', '""')}"`);

function measurementsCsv(state) {
  const names = Object.keys(LIVE.units), given = Object.keys(LIVE.uncertainties);
  const heads = names.flatMap((name) => {
    const unit = `[${LIVE.units[name]}]`;
    return given.includes(name) ? [`${name} ${unit}`, `u(${name}) ${unit}`] : [`${name} ${unit}`];
  });
  const lines = usedTests(state).map(({ label, cells }) => {
    const fields = names.flatMap((name) => {
      const known = LIVE.uncertainties[name];
      return known ? [cells[name], known[label] ?? lastDigitUncertainty(cells[name])] : [cells[name]];
    });
    return [String(label), ...fields];
  });
  return [["test", ...heads], ...lines].map((fields) => fields.map(csvField).join(",") + "\n").join("");
}

// What stands for the uncertainty of a number that came without one: half a unit of its last digit, rectangular.
function lastDigitUncertainty(text) {
  return NUMBER.test(text) ? brief(10 ** -decimalsOf(text) / 2 / Math.sqrt(3)) : "";
}

function reportToml(state) {
  return LIVE.toml.map((piece) => {
    if (typeof piece === "string") return piece;
    if (piece.file) return piece.file;
    const text = state.parameters[piece.parameter];
    if (!piece.line) return text;
    const same = text === page.history.issued.parameters[piece.parameter];
    return same ? "" : `${piece.parameter} = "${text}${piece.unit ? ` ${piece.unit}` : ""}"\n`;
  }).join("");
}

function save() {
  const box = byId("live-downloads"), state = page.history.now;
  for (const link of all("a", box)) URL.revokeObjectURL(link.href);
  const files = [["measurements.csv", measurementsCsv(state), "text/csv"], ["report.toml", reportToml(state), "application/toml"]];
  const links = files.map(([name, text, type]) => {
    const url = URL.createObjectURL(new Blob([text], { type: `${type};charset=utf-8` }));
    return make("a", { href: url, download: name }, name);
  });
  box.replaceChildren("saved: ", ...links.flatMap((link, n) => (n ? [" ", link] : [link])));
  box.hidden = false;
  // WebKit drops a download that has not begun when the next one is asked for.
  links.forEach((link, n) => setTimeout(() => link.click(), 200 * n));
  say(`Saved ${files.map(([name]) => name).join(" and ")}.`);
}
