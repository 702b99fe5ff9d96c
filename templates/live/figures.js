// Pictures after an edit: those on the screen are drawn at once; all others are blank until they are, as they come near
// to it or, one after the other, a moment later. Print has them all.

const WHEN_IDLE = 50; // milliseconds in which nothing else was edited

const pictures = {
  seen: new Set(), late: new Map(), timer: 0,
  watcher: new IntersectionObserver((entries) => {
    for (const { target, isIntersecting } of entries) {
      pictures.seen[isIntersecting ? "add" : "delete"](target);
      if (isIntersecting) drawLate(target);
    }
  }, { rootMargin: "50%" }),
};

// Draws in a place now, if it is seen; else what was asked for last.
function drawIn(place, draws) {
  pictures.late.set(place, draws);
  if (pictures.seen.has(place)) drawLate(place);
  else place.setAttribute("aria-busy", "true");
  clearTimeout(pictures.timer);
  pictures.timer = setTimeout(drawNext, WHEN_IDLE);
}

function drawLate(place) {
  const draws = pictures.late.get(place);
  forget(place);
  draws?.();
}

function forget(place) {
  pictures.late.delete(place);
  place.removeAttribute("aria-busy");
}

function drawNext() {
  for (const place of pictures.late.keys()) {
    drawLate(place);
    pictures.timer = setTimeout(drawNext);
    return;
  }
}

addEventListener("beforeprint", () => [...pictures.late.keys()].forEach(drawLate));

// Where nothing is to be drawn, the page has nothing that draws.
function writeFigures(look) {
  for (const [name, chart] of Object.entries(LIVE.figures)) {
    const place = byId(`figure-${name}`), card = place?.querySelector(".card");
    if (card) drawIn(place, () => {
      const made = drawChart(chart, look);
      const alt = page.kept.find(([part]) => part === card)[1].firstElementChild.getAttribute("aria-label");
      if (made) made.svg.setAttribute("aria-label", `${alt} Redrawn after an edit: ${made.says}`);
      card.replaceChildren(made?.svg ?? make("p", { class: "nothing" }, "Nothing to draw: the cells that it shows have no value."));
    });
  }
}
