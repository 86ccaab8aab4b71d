"use strict";
// The plots of one case: linked, zoomable, with faults as bands and limits as lines.

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
