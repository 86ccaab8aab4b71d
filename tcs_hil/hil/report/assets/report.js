"use strict";
// A case is decoded and drawn when it is first opened: the page stays light with a hundred of them.

const results = JSON.parse(document.getElementById("results").textContent);
const SLIP = ["truth.slip_ratio_fl", "truth.slip_ratio_fr"];

// Each line: channel, label, colour, and whether it belongs to the background.
const PANELS = [
  { title: "slip ratio", wide: true, floor: true, lines: [
    ["service.slip_ratio_fl", "left, estimated", "left", true], ["service.slip_ratio_fr", "right, estimated", "right", true],
    [SLIP[0], "left", "left"], [SLIP[1], "right", "right"]], reference: true },
  { title: "torque, left motor · Nm", floor: true, lines: [["truth.request_nm", "request", "request"],
    ["service.limit_fl_nm", "limit", "limit"], ["truth.motor_torque_fl_nm", "motor", "left"]] },
  { title: "torque, right motor · Nm", floor: true, lines: [["truth.request_nm", "request", "request"],
    ["service.limit_fr_nm", "limit", "limit"], ["truth.motor_torque_fr_nm", "motor", "right"]] },
  { title: "speed · km/h", floor: true, lines: [["wheel fl", "wheel left", "left"], ["wheel fr", "wheel right", "right"], ["car", "car", "ink"]] },
  { title: "friction coefficient", floor: true, lines: [["truth.mu_fl", "left", "left"], ["truth.mu_fr", "right", "right"]], steps: true },
  { title: "state", lines: [["service.state", "state", "third"]], steps: true },
];
const STAGES = ["wake", "receive", "solve_fl", "solve_fr", "decide", "send"];

const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
const element = (tag, className, text) => {
  const made = document.createElement(tag);
  if (className) made.className = className;
  if (text !== undefined) made.textContent = text;
  return made;
};
const written = (value, digits = 4) => value == null ? "–" : Number(value.toPrecision(digits)).toString();

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

// ---- plots ---------------------------------------------------------------

function shading(picture, panel) {
  const names = panel.lines.map((line) => line[0]);
  const across = (u, from, to) => {
    const end = to == null ? u.scales.x.max : Math.min(to, u.scales.x.max);
    const begin = Math.max(from, u.scales.x.min);
    return end > begin ? [u.valToPos(begin, "x", true), u.valToPos(end, "x", true)] : null;
  };
  const faults = (u) => {
    const spans = new Map(picture.faults.map((fault) => [`${fault.from_s} ${fault.to_s}`, fault]));
    for (const fault of spans.values()) {
      const edges = across(u, fault.from_s, fault.to_s);
      if (!edges) continue;
      u.ctx.fillStyle = colour("fault");
      u.ctx.fillRect(edges[0], u.bbox.top, edges[1] - edges[0], u.bbox.height);
    }
    if (panel.wide) labels(u);
  };
  const labels = (u) => {
    u.ctx.fillStyle = colour("soft");
    u.ctx.font = `${11 * devicePixelRatio}px system-ui, sans-serif`;
    u.ctx.textAlign = "left"; u.ctx.textBaseline = "top";
    const rows = new Map();
    for (const fault of picture.faults) {
      const edges = across(u, fault.from_s, fault.to_s);
      if (!edges) continue;
      const row = rows.get(fault.from_s) ?? 0;
      rows.set(fault.from_s, row + 1);
      u.ctx.fillText(fault.label, edges[0] + 5, u.bbox.top + 4 + 14 * devicePixelRatio * row);
    }
  };
  const limits = (u) => {
    u.ctx.save();
    u.ctx.beginPath(); u.ctx.rect(u.bbox.left, u.bbox.top, u.bbox.width, u.bbox.height); u.ctx.clip();
    u.ctx.strokeStyle = colour("failed"); u.ctx.lineWidth = 1.25 * devicePixelRatio;
    u.ctx.setLineDash([5 * devicePixelRatio, 4 * devicePixelRatio]);
    for (const limit of picture.limits.filter((each) => each.channels.some((name) => names.includes(name)))) {
      const edges = across(u, limit.from_s, limit.to_s), height = u.valToPos(limit.value, "y", true);
      if (!edges) continue;
      u.ctx.beginPath(); u.ctx.moveTo(edges[0], height); u.ctx.lineTo(edges[1], height); u.ctx.stroke();
    }
    u.ctx.restore();
  };
  return { drawClear: [faults], draw: [limits] };
}

function seriesOf(panel, labels) {
  const value = (_, v) => labels && v != null ? labels[v] ?? written(v) : written(v);
  return panel.lines.map(([, label, tone, pale]) => ({
    label, value, spanGaps: false, points: { show: false },
    stroke: () => colour(tone) + (pale ? "66" : ""), width: pale ? 1 : 1.5,
    paths: panel.steps ? uPlot.paths.stepped({ align: 1 }) : undefined,
  }));
}

function axes(labels) {
  const look = { stroke: () => colour("soft"), grid: { stroke: () => colour("grid"), width: 1 }, ticks: { show: false },
    font: "11px system-ui, sans-serif" };
  const named = labels && {
    splits: () => Object.keys(labels).map(Number), values: (_, marks) => marks.map((mark) => labels[mark]), size: 84,
  };
  return [{ ...look, values: (_, marks) => marks.map((mark) => `${written(mark, 6)} s`), size: 28, space: 70 },
    { ...look, size: 52, ...named }];
}

function range(labels, picture, panel) {
  if (labels) { const known = Object.keys(labels).map(Number); return [Math.min(...known) - .4, Math.max(...known) + .4]; }
  const names = panel.lines.map((line) => line[0]);
  const values = picture.limits.filter((limit) => limit.channels.some((name) => names.includes(name))).map((limit) => limit.value);
  return (_, low, high) => {
    const bottom = panel.floor ? Math.min(low ?? 0, 0) : low ?? 0, top = Math.max(high ?? 1, ...values.filter((v) => v < 3 * (high ?? 1)));
    const room = Math.max((top - bottom) * .06, 1e-6);
    return [bottom - room, top + room];
  };
}

function plotted(host, panel, channels, picture, linked) {
  const present = { ...panel, lines: panel.lines.filter(([name]) => channels[name]) };
  const named = picture.labels[present.lines[0]?.[0]];
  const labels = named && Object.fromEntries(Object.entries(named).map(([label, value]) => [value, label]));
  const plot = new uPlot({
    width: host.clientWidth, height: panel.wide ? 260 : 190, series: [{ label: "time", value: (_, v) => v == null ? "–" : `${v.toFixed(3)} s` },
      ...seriesOf(present, labels)],
    axes: axes(labels), scales: { x: { time: false }, y: { range: range(labels, picture, present) } },
    cursor: { sync: { key: linked.key }, drag: { x: true, y: false }, points: { size: 5 } },
    hooks: { ...shading(picture, present), setScale: [(u, scale) => scale === "x" && linked.follow(u)] },
  }, [channels.time, ...present.lines.map(([name]) => channels[name])], host);
  linked.plots.push(plot);
}

// What one plot of a case is zoomed to, all of them are.
function linkage(key) {
  let following = false;
  return { key, plots: [], follow(leader) {
    if (following) return;
    following = true;
    const { min, max } = leader.scales.x;
    this.plots.forEach((plot) => plot !== leader && plot.setScale("x", { min, max }));
    following = false;
  } };
}

function withReference(panel, channels, picture) {
  if (!panel.reference) return panel;
  channels.reference = channels.time.map(() => picture.reference);
  return { ...panel, lines: [["reference", "reference", "request"], ...panel.lines] };
}

function withEarlier(panel, channels) {
  const earlier = panel.lines.filter(([name, , , pale]) => !pale && channels[`earlier ${name}`]
    && (SLIP.includes(name) || name.includes("motor_torque") || name === "car"));
  return { ...panel, lines: [...earlier.map(([name, label, tone]) => [`earlier ${name}`, `${label}, earlier`, tone, true]), ...panel.lines] };
}

function extraPanels(picture) {
  const known = new Set(PANELS.flatMap((panel) => panel.lines.map((line) => line[0])));
  return Object.keys(picture.units).filter((name) => !known.has(name)).map((name) => ({
    title: picture.units[name] ? `${name} · ${picture.units[name]}` : name, lines: [[name, name, "third"]], steps: name in picture.labels,
  }));
}

function histogram(host, data) {
  const width = (data.high_us - data.low_us) / data.counts.length || 1;
  const middles = data.counts.map((_, i) => data.low_us + (i + .5) * width);
  const look = axes();
  look[0].values = (_, marks) => marks.map((mark) => `${written(mark)} µs`);
  look[1].values = (_, marks) => marks.map((mark) => Number.isInteger(Math.log10(mark)) ? mark : "");
  const bars = { label: "ticks", stroke: () => colour("left"), fill: () => colour("left") + "55", points: { show: false },
    paths: uPlot.paths.bars({ size: [1, Infinity], align: 0 }) };
  return new uPlot({ width: host.clientWidth, height: 190, axes: look, legend: { show: false }, cursor: { show: false },
    scales: { x: { time: false, range: [data.low_us, data.high_us + width] }, y: { distr: 3, range: (_, __, high) => [.5, 1.5 * high] } },
    series: [{}, bars],
  }, [middles, data.counts.map((count) => count || null)], host);
}

function worstTicks(ticks) {
  const table = element("table", "ticks"), head = table.createTHead().insertRow();
  for (const name of ["at", "took µs", ...STAGES, "state"]) head.append(element("th", "number", name));
  for (const tick of ticks) {
    const row = table.insertRow();
    row.append(element("td", "number", `${tick.at_s.toFixed(3)} s`), element("td", "number", tick.response_us.toFixed(0)));
    for (const stage of STAGES) row.append(element("td", stage === tick.culprit ? "number blame" : "number", tick.stages_us[stage].toFixed(0)));
    row.append(element("td", "number", tick.state));
  }
  return table;
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
