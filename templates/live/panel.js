// Beside the table that is edited: the result, as issued and now, and a picture of it. Where there is no room
// beside the table it stands at the top of the window, while one is in the table.

const MOST_DRAWN = 4; // results; of the others, and of the number in the bar, one asks by selecting it

function makePanel() {
  const table = page.tables.find((one) => one.editable), names = LIVE.headline;
  if (!table || !names.length) return;
  // What scrolls stays, and so where it stands: to ask for that would lay out the page in the middle of an edit.
  const results = make("div", { class: "results", tabindex: 0, "aria-label": "all results" });
  page.panel = make("div", { id: "live-panel", role: "group", "aria-label": "The result while you edit" }, results);
  pictures.watcher.observe(page.panel);
  const block = table.element.closest(".table"), around = make("div", { class: "edited-beside" });
  block.before(around);
  around.append(page.panel, block);
  writePanel(page.look);
  placePanel();
}

// Half of what holds 95 % of the draws, and over u by the law of propagation. Errors that are known with few degrees of
// freedom are drawn from t distributions: they deviate by more than u, and as often from U.
const halfOf = ({ ends }) => (ends ? (ends[1] - ends[0]) / 2 : NaN);
function factorOf(look, name, row) {
  const { factor } = look.sure.budget(name, row);
  return factor > 0 ? factor : studentFactor(Infinity);
}

function writePanel(look) {
  if (!page.panel) return;
  const rows = LIVE.headline.map(([name, index], place) => {
    const [was, row] = [page.issued, look].map((one) => one.trace.row(name, index)), before = page.issued.cell(name, was).text, now = row < 0 ? "–" : look.cell(name, row).text, same = before === now;
    // Draws may tell another interval than the law of propagation does, or none.
    const live = LIVE.shared && row >= 0, drawn = carlo.found[[name, row]], u = knownU(look, name, row);
    const other = live && drawn && !(u && Math.abs(halfOf(drawn) / LIVE.columns[name].scale / (u * factorOf(look, name, row)) - 1) <= OFF);
    const more = live && isEdited() && look.trace.isOk(name, row) ? [...(other ? ["draws differ"] : []), ...(place < MOST_DRAWN ? [shortDraws(name, row)] : [])] : [];
    const called = index ? ` ${page.issued.trace.word(name, was) ?? index}` : "";
    return make("tr", {}, make("th", { scope: "row" }, make("abbr", { title: meaningOf(name) }, ...part(name, "symbol")), called),
      make("td", {}, same ? "" : before), make("td", { class: same ? "" : "changed" }, now, u && !other ? ` (${told(u, LIVE.most).digits})` : "", ...more.map((text) => make("span", {}, text))));
  });
  const head = make("tr", {}, ...["result", "as issued", LIVE.shared ? "now (u)" : "now"].map((text) => make("th", { scope: "col" }, text)));
  if (LIVE.shared) head.lastChild.append(make("span", {}, `95\u00a0% of ${DRAWS} draws`));
  // So that there is room for what is edited, more results than some are scrolled to.
  page.panel.firstChild.replaceChildren(make("table", {}, make("thead", {}, head), make("tbody", {}, ...rows)));
  // The last of the pictures that is one: those before it show steps on the way.
  const chart = Object.values(LIVE.figures).findLast(({ panels }) => !panels);
  if (chart) drawIn(page.panel, () => {
    const picture = drawChart({ ...chart, ...SMALL }, look)?.svg;
    picture?.setAttribute("aria-hidden", "true"); // the same stands in the report, with words
    page.panel.querySelector("svg")?.remove();
    if (picture) page.panel.append(picture);
  });
}

// Which results had a value as issued and have none now; if none, which other cells, and so all that needs them.
function lost({ trace }) {
  const was = page.issued.trace, there = (one, [name, index]) => one.isOk(name, one.row(name, index)), gone = LIVE.headline.filter((cell) => there(was, cell) && !there(trace, cell)).map(([name, index]) => was.address(name, was.row(name, index)));
  const begun = trace.errors.filter(({ name, row }) => {
    const before = was.row(name, trace.index(name, row));
    return !LIVE.columns[name].of && (before < 0 || was.isOk(name, before)); // an input, not its uncertainty as well
  });
  const what = gone.length ? gone : begun.map(({ name, row }) => trace.address(name, row)), more = what.length - MOST_DRAWN;
  if (!what.length) return "";
  const alone = begun.some(({ name }) => LIVE.paired?.includes(name)) ? " Of paired readings a build takes none alone: leave the row out." : "";
  return ` Without a value now: ${what.slice(0, MOST_DRAWN).join(", ")}${more > 0 ? ` and ${more} more` : ""}${gone.length ? "" : ", and what needs it"}.${alone}`;
}

function placePanel() {
  if (!page.panel) return;
  const around = page.panel.parentElement, table = around.querySelector(".table table");
  const room = around.clientWidth - table.offsetWidth - 24;
  page.panel.classList.add("beside"); // as it would stand there, no number broken
  page.panel.style.width = "min-content";
  const beside = page.panel.offsetWidth <= room;
  page.panel.classList.toggle("beside", beside);
  page.panel.style.width = beside ? `${Math.min(room, 320)}px` : "";
}

// What stands beside the report: buttons that copy tables, the result beside what is edited, and what chapters
// say of themselves that no script can compute again.
function makeAround() {
  for (const box of all("main .table")) box.prepend(make("button", { type: "button", class: "copy", "data-copy": true, title: "copy this table" }, "Copy"));
  // Of a chapter that follows in part, what does not says it.
  const parts = all("[data-issued]").flatMap((chapter) => {
    const rest = LIVE.shared && chapter.querySelector("#uncertain") && all(".table:not(#uncertain)", chapter);
    return rest ? rest.map((table) => [table.firstChild, "table"]) : [[chapter.querySelector("h2"), "chapter"]];
  });
  for (const list of all("main .decided")) parts.push([list, "decision"]);
  for (const legend of all("main .legend")) if (legend.textContent.includes("Stated uncertainties:")) parts.push([legend, "list of stated uncertainties"]);
  const left = LIVE.shared ? [] : all(".headline .sure");
  for (const u of left) u.classList.add("decided");
  if (left[0]) parts.push([left[0].closest(".headline"), "expanded uncertainty"]);
  if (LIVE.shared) for (const first of all(".headline, #uncertain > :first-child")) parts.push([first]);
  page.stale = parts.map(([place, what]) => {
    const word = make("p", { class: "stale", hidden: true }, what ? `This ${what} is as issued, before the edits.` : "This browser tells U by first order alone: a build says where the second counts.");
    word.alone = !what;
    if (what === "decision") word.append((page.decided = make("span")));
    place.after(word);
    return word;
  });
  const results = byId("uncertain"), legend = results?.querySelector(".legend"), now = make("p", { class: "legend", hidden: true });
  if (results && LIVE.shared) {
    page.doubts = [legend, now];
    results.append(now);
  }
  makePanel();
}

function tellStale() {
  page.doubts?.forEach((one, n) => one && (one.hidden = isEdited() !== Boolean(n)));
  if (!isEdited()) page.doubts?.[1].replaceChildren();
  for (const word of page.stale) word.hidden = !isEdited() || (word.alone && !carlo.refused);
}
