// Published values beside their recomputation, and the sentences that count them.

// What is not as expected of a published value. `known` is what it is known to differ to, null if it shall not
// differ, nothing if no number would do; `other` is what there is to find even so.
function findingOf(same, again, known, other) {
  if (known === null) return same ? "" : other;
  if (same) return LIVE.findings.unexpected;
  return known === "" || again === known ? other : LIVE.findings.otherwise;
}

function compared(look, [cell, index, text, scale, truncated, known, other]) {
  const row = look.trace.row(cell, index);
  if (row < 0) return { again: "–", verdict: "left out", finding: "" };
  if (!look.trace.isOk(cell, row)) {
    const again = CODES[look.trace.sheet.status[cell][row]];
    const finding = known === null ? LIVE.findings.unexpected : findingOf(false, again, known, other);
    return { again, verdict: "no value", finding };
  }
  const { again, distance, same } = beside(look.trace.sheet.value[cell][row], text, (scale || [1, 1]).map(BigInt), truncated);
  const open = !same && known === null && !asIssued(look, cell, index); // whether that is a finding, a referee decides
  return { again, distance, verdict: same ? "same" : "differs", finding: open ? "" : findingOf(same, again, known, other), open };
}

function asIssued(look, cell, index) {
  const now = look.trace.row(cell, index), before = look.issued.trace.row(cell, index);
  return now >= 0 && before >= 0 && isSameCell(look, cell, now, look.issued, before);
}

const distanceText = (distance) => signedText(decimals(distance, 1));

function writePublished(look) {
  const groups = LIVE.published.map((group) => ({ ...group, found: group.rows.map((row) => compared(look, row)) }));
  for (const { id, rows, called, found } of groups) {
    const body = byId(id)?.querySelector("tbody");
    if (!body) continue;
    found.forEach(({ again, distance, verdict, finding }, place) => {
      const row = body.rows[place], cells = row.cells;
      setText(cells[3], again);
      setText(cells[5], distance === undefined ? "" : distanceText(distance));
      setText(cells[6], verdict + (finding && `, ${finding}`));
      row.classList.toggle("unexpected", finding !== "");
      cells[3].classList.toggle("changed", !asIssued(look, ...rows[place]));
    });
    writeGroup(groups.findIndex((group) => group.id === id), rows, called, found);
  }
  writeTally(groups.flatMap((group) => group.found).filter(counts));
}

// What rests on a test that is left out is no finding, and a build does not count it.
const counts = (one) => one.verdict !== "left out";

const comes = (count) => `${count || "none"} ${count > 1 ? "come" : "comes"}`;

// The sentence under the result that counts all published values: the one that leads to their tables.
function writeTally(found) {
  const element = all("#result > p").find((p) => p.querySelector('a[href="#published"]'));
  if (!element) return;
  const count = (verdict) => found.filter((one) => one.verdict === verdict).length;
  const differing = count("differs"), unchecked = count("no value"), surprises = found.filter((one) => one.finding).length, open = found.filter((one) => one.open).length;
  const parts = [`Of ${plural(found.length, "published value")}, ${comes(count("same"))} out as printed`];
  if (differing) parts.push(` and ${differing} ${differing === 1 ? "differs" : "differ"}`);
  if (unchecked) parts.push(`; ${unchecked} could not be compared`);
  const sentences = [`${parts.join("")}. `, element.querySelector("a")];
  if (surprises) {
    const was = surprises === 1 ? "was" : "were";
    sentences.push(" ", make("strong", {}, `${surprises} of these findings ${was} not expected.`));
  }
  if (open) sentences.push(` A build of what stands here tells whether printed digits explain ${open === 1 ? "one" : open} of these differences.`);
  const text = sentences.map((one) => one.textContent ?? one).join("");
  if (element.textContent !== text) element.replaceChildren(...sentences);
}

// The line that sums up one table of the source: rewritten behind its title.
function writeGroup(place, rows, called, found) {
  const element = all("#published > ul > li")[place], start = /: of \d+ values? .*/s;
  const node = element && Array.from(element.childNodes).find((one) => one.nodeType === Node.TEXT_NODE && start.test(one.data));
  if (!node) return;
  while (node.nextSibling) node.nextSibling.remove();
  const count = found.filter(counts).length, same = found.filter((one) => one.verdict === "same").length;
  const known = found.map((one, row) => ({ ...one, called: called[row], text: rows[row][2] })).filter((one) => one.distance !== undefined);
  const furthest = known.reduce((a, b) => (a && Math.abs(a.distance) >= Math.abs(b.distance) ? a : b), null);
  const of = furthest?.called ? ` of ${furthest.called}` : "";
  const off = furthest && same < count
    ? `; the furthest is off by ${distanceText(furthest.distance)} units, ${furthest.again} against the published ${furthest.text}${of}`
    : "";
  const text = node.data.replace(start, () => `: of ${plural(count, "value")} ${comes(same)} out as printed${off}.`);
  if (node.data !== text) node.data = text;
}
