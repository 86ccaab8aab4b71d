"use strict";
// A case is decoded and drawn when it is first opened: the page stays light with a hundred of them.

const results = JSON.parse(document.getElementById("results").textContent);

// ---- data ----------------------------------------------------------------

async function unpacked(traces) {
  const bytes = Uint8Array.from(atob(traces.data), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  const levels = new DataView(await new Response(stream).arrayBuffer());
  const channels = { time: Array.from({ length: traces.count }, (_, i) => traces.start_s + i * traces.step_s) };
  traces.names.forEach((name, place) => {
    const [low, high] = traces.ranges[place];
    channels[name] = Array.from({ length: traces.count }, (_, i) => {
      const level = levels.getInt16(2 * (place * traces.count + i), true);
      return level === -32768 ? null : low + (level + 32767) / 65534 * (high - low);
    });
  });
  return channels;
}

function pictureOf(kind, name) {
  const script = document.querySelector(`script[data-${kind}="${CSS.escape(name)}"]`);
  return script ? JSON.parse(script.textContent) : null;
}

// The earlier run on this run's times: both begin at zero.
function resampled(values, from, onto) {
  const step = from[1] - from[0];
  return onto.map((time) => values[Math.round((time - from[0]) / step)] ?? null);
}

// ---- a case --------------------------------------------------------------

function findings(result) {
  const table = element("table", "findings");
  const order = ["failed", "blocked", "passed"];
  for (const finding of [...result.findings].sort((a, b) => order.indexOf(a.verdict) - order.indexOf(b.verdict))) {
    const row = table.insertRow();
    row.insertCell().append(element("span", `verdict ${finding.verdict}`, finding.verdict));
    row.append(element("td", "", finding.limit), element("td", "why", finding.reason));
  }
  return table;
}

async function draw(cell, result) {
  cell.append(element("p", "lead", `${result.description} · ${result.mode} · ${result.wall_s.toFixed(1)} s`), findings(result));
  const picture = pictureOf("picture", result.name);
  if (!picture) return;
  const grid = cell.appendChild(element("div", "plots"));
  const channels = await unpacked(picture.traces), before = pictureOf("earlier", result.name);
  if (before) {
    const old = await unpacked(before.traces);
    for (const name of before.traces.names) channels[`earlier ${name}`] = resampled(old[name], old.time, channels.time);
  }
  const linked = linkage(result.name), others = [];
  for (const panel of [...PANELS, ...extraPanels(picture)]) {
    const host = grid.appendChild(element("section", panel.wide ? "wide" : ""));
    host.append(element("h2", "", panel.title));
    plotted(host, withReference(withEarlier(panel, channels), channels, picture), channels, picture, linked);
  }
  if (picture.histogram) {
    const host = grid.appendChild(element("section"));
    host.append(element("h2", "", `${picture.histogram.what} · ticks per bin`));
    others.push(histogram(host, picture.histogram));
  }
  const slow = grid.appendChild(element("section"));
  slow.append(element("h2", "", "slowest ticks · the stage to blame in red"), worstTicks(picture.worst));
  cell.plots = [...linked.plots, ...others];
}

async function toggle(body, open) {
  const row = body.rows[0], shown = body.rows[1];
  const wanted = open ?? !(shown && !shown.hidden);
  row.setAttribute("aria-expanded", wanted);
  if (shown) shown.hidden = !wanted;
  else if (wanted) {
    const detail = body.insertRow();
    detail.className = "detail";
    const cell = detail.insertCell();
    cell.colSpan = row.cells.length;
    await draw(cell, results[body.dataset.index]);
    body.dataset.drawn = "yes";
  }
}

// ---- the page ------------------------------------------------------------

const bodies = [...document.querySelectorAll("tbody.case")];
const search = document.getElementById("search");
let wantedVerdict = "";

function filter() {
  const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
  let shown = 0;
  for (const body of bodies) {
    const text = body.rows[0].textContent.toLowerCase();
    body.hidden = !((!wantedVerdict || body.dataset.verdict === wantedVerdict) && words.every((word) => text.includes(word)));
    shown += !body.hidden;
  }
  document.getElementById("nothing").hidden = shown > 0;
}

function redraw() { document.querySelectorAll(".detail > td").forEach((cell) => cell.plots?.forEach((plot) => plot.redraw(false, true))); }

function theme(name) { document.documentElement.dataset.theme = name; redraw(); }

const prefersDark = matchMedia("(prefers-color-scheme: dark)");
theme(prefersDark.matches ? "dark" : "light");
prefersDark.addEventListener("change", () => theme(prefersDark.matches ? "dark" : "light"));
document.getElementById("theme").addEventListener("click", () => theme(document.documentElement.dataset.theme === "dark" ? "light" : "dark"));

search.addEventListener("input", filter);
document.querySelectorAll(".chip").forEach((chip) => chip.addEventListener("click", () => {
  document.querySelector(".chip.on").classList.remove("on");
  chip.classList.add("on");
  wantedVerdict = chip.dataset.verdict;
  filter();
}));
bodies.forEach((body) => {
  body.rows[0].addEventListener("click", () => { if (getSelection().isCollapsed) toggle(body); });
  body.rows[0].addEventListener("keydown", (event) => {
    if (event.key === "Enter" || event.key === " ") { event.preventDefault(); toggle(body); }
  });
});
addEventListener("resize", () => document.querySelectorAll(".detail:not([hidden]) > td").forEach((cell) =>
  cell.plots?.forEach((plot) => plot.setSize({ width: plot.root.parentElement.clientWidth, height: plot.height }))));

// A link to a case opens it; so does being the only one.
const linkedTo = document.getElementById(decodeURIComponent(location.hash.slice(1)));
if (linkedTo) toggle(linkedTo, true).then(() => linkedTo.scrollIntoView());
else if (bodies.length === 1) toggle(bodies[0], true);
