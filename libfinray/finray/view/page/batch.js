// The page of all logs of a batch.

const STATUS_COLOURS = {ok: "--good", no_contact: "--quiet", unobservable: "--warn", not_converged: "--bad", bad_input: "--ink"};
const GAUGE_COLOURS = ["--after", "--before", "--held", "--fourth", "--warn", "--bad"];

function make(tag, attributes = {}, ...children) {
  const svg = ["svg", "path", "line", "circle", "text", "rect", "title", "g"].includes(tag) && attributes.svg !== false;
  const element = svg ? document.createElementNS("http://www.w3.org/2000/svg", tag) : document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name === "class") element.setAttribute("class", value);
    else if (name === "style") element.style.cssText = value;
    else element.setAttribute(name, value);
  }
  element.append(...children.filter(child => child !== null && child !== ""));
  return element;
}

const percent = (part, whole) => whole ? `${(100 * part / whole).toFixed(part && part / whole < 0.1 ? 1 : 0)} %` : "–";
const solved = log => (log.status.ok || 0) + (log.status.no_contact || 0) + (log.status.unobservable || 0);
const isAmber = log => log.warnings.length > 0;

function statusBar(log) {
  const words = Object.entries(log.status).map(([name, count]) => `${name} ${count}`).join(", ");
  const bar = make("div", {class: "share", title: words, role: "img", "aria-label": words});
  for (const [name, count] of Object.entries(log.status)) {
    bar.append(make("i", {style: `width:${100 * count / log.frames}%;background:var(${STATUS_COLOURS[name]})`}));
  }
  return bar;
}

function tableOf(head, rows) {
  const table = make("table", {}, make("tr", {}, ...head.map(([text, kind]) => make("th", {class: kind || ""}, text))));
  for (const {cells, kind} of rows) {
    table.append(make("tr", {class: kind || ""}, ...cells.map((cell, c) => make("td", {class: head[c][1] || ""}, cell))));
  }
  return make("div", {class: "scroll"}, table);
}

function logTable(finger) {
  return tableOf([["log", "text"], ["day", "text"], ["frames"], ["status", "text"], ["ok"], ["unobservable"], ["unexplained"], ["force error"], ["warnings", "text"]],
    finger.logs.map(log => ({kind: isAmber(log) ? "amber" : "", cells: [
      make("a", {href: log.page}, log.name), log.day || "–", String(log.frames), statusBar(log),
      percent(log.status.ok || 0, log.frames), percent(log.status.unobservable || 0, log.frames), percent(log.unexplained, solved(log)),
      log.force_rms_N === null ? "–" : `${log.force_rms_N.toPrecision(2)} N`,
      log.warnings.map(w => w.code.replaceAll("_", " ")).join(", ") || "–"]})));
}

function worstTable(finger) {
  const frames = finger.logs.flatMap(log => log.worst.map(frame => ({log, ...frame}))).sort((a, b) => a.p - b.p).slice(0, 20);
  if (!frames.length) return make("p", {class: "quiet"}, "No frame has a p-value below 0.001.");
  return tableOf([["log", "text"], ["frame"], ["time"], ["p-value"]], frames.map(f => ({cells: [
    make("a", {href: `${f.log.page}#frame=${f.frame + 1}`}, f.log.name), String(f.frame + 1),
    f.time_s === null ? "–" : `${f.time_s.toFixed(3)} s`, f.p === 0 ? "0" : f.p.toExponential(1).replace("-", "−")]})));
}

// Values of each log over days, or in the order of logs where days are not known; `lines`: {label, colour, values}.
function drift(finger, title, unit, lines) {
  const WIDTH = Math.max(280, Math.min(720, document.body.clientWidth - 24)), HEIGHT = 200, LEFT = 56, BOTTOM = 26, TOP = 36, logs = finger.logs;
  const values = lines.flatMap(line => line.values).filter(value => value !== null && isFinite(value));
  if (!values.length) return "";
  const byDay = logs.every(log => log.day), days = logs.map((log, i) => byDay ? Date.parse(log.day) / 864e5 : i);
  const first = Math.min(...days), span = Math.max(...days) - first || 1;
  let low = Math.min(0, ...values), high = Math.max(0, ...values);
  if (low === high) high = low + 1;
  const x = i => LEFT + 8 + (WIDTH - LEFT - 20) * (days[i] - first) / span;
  const y = value => HEIGHT - BOTTOM - (HEIGHT - BOTTOM - TOP) * (value - low) / (high - low);
  const svg = make("svg", {viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", "aria-label": title, style: "font:11px var(--font);width:100%;max-width:45rem"});
  const text = (x, y, words, anchor, colour) => svg.append(make("text", {x, y, "text-anchor": anchor, style: `fill:var(${colour || "--quiet"})`}, words));
  for (const value of [low, (low + high) / 2, high]) {
    svg.append(make("line", {x1: LEFT, x2: WIDTH, y1: y(value), y2: y(value), style: "stroke:var(--line)"}));
    text(LEFT - 5, y(value) + 4, value.toPrecision(2).replace("-", "−"), "end");
  }
  for (const i of [0, logs.length - 1]) {
    text(x(days.indexOf(i ? Math.max(...days) : first)), HEIGHT - 8, byDay ? logs[days.indexOf(i ? Math.max(...days) : first)].day : `log ${i + 1}`, i ? "end" : "start");
    if (logs.length === 1 || span === 1 && days.every(day => day === first)) break;
  }
  text(LEFT, 13, `${title} (${unit})`, "start", "--ink");
  lines.forEach((line, k) => {
    const colour = `var(${line.colour})`, points = line.values.map((value, i) => [days[i], value, i]).filter(p => p[1] !== null && isFinite(p[1])).sort((a, b) => a[0] - b[0]);
    svg.append(make("path", {d: points.map(([, value, i], n) => `${n ? "L" : "M"}${x(i).toFixed(1)} ${y(value).toFixed(1)}`).join(""), style: `fill:none;stroke:${colour};stroke-width:1.5`}));
    for (const [, value, i] of points) {
      const amber = isAmber(logs[i]), title = make("title", {}, `${logs[i].name}: ${value.toPrecision(3)} ${unit}${amber ? ", with a warning" : ""}`);
      svg.append(amber ? make("rect", {x: x(i) - 4, y: y(value) - 4, width: 8, height: 8, style: `fill:var(--ground);stroke:var(--warn);stroke-width:2`}, title)
                       : make("circle", {cx: x(i), cy: y(value), r: 3, style: `fill:${colour}`}, title));
    }
    if (line.label) text(LEFT + (WIDTH < 500 ? 54 : 78) * k, 28, line.label, "start", line.colour);
  });
  return svg;
}

function section(finger) {
  const kind = {good: "", unchecked: "plain", watch: "warn", zero: "warn", calibrate: "no", repair: "no"}[finger.verdict];
  const out = make("section", {}, make("h2", {}, finger.name),
    make("div", {class: "verdict " + kind}, make("span", {class: "chip " + finger.verdict}, finger.verdict), " ", finger.words));
  for (const log of [{name: "", warnings: finger.warnings}, ...finger.logs]) {
    for (const warning of log.warnings) {
      out.append(make("div", {class: "warning"}, make("b", {}, warning.code.replaceAll("_", " ") + ": "), `${warning.text}; ${warning.remedy}.`));
    }
  }
  out.append(make("h2", {}, "Logs"), logTable(finger), make("h2", {}, "Frames that are explained least"), worstTable(finger));
  const gauges = Math.max(0, ...finger.logs.map(log => log.free_V.length)), zero = [];
  for (let j = 0; j < gauges; j++) {
    const from = finger.logs.find(log => log.free_V.length > j).free_V[j];
    zero.push({label: `gauge ${j + 1}`, colour: GAUGE_COLOURS[j % GAUGE_COLOURS.length],
               values: finger.logs.map(log => log.free_V.length > j ? 1000 * (log.free_V[j] - from) : null)});
  }
  const plots = [drift(finger, "Gauges of the free finger, since the first log", "mV", zero),
    drift(finger, "Force error, rms", "N", [{colour: "--after", values: finger.logs.map(log => log.force_rms_N)}]),
    drift(finger, "Unexplained frames", "%", [{colour: "--after", values: finger.logs.map(log => solved(log) ? 100 * log.unexplained / solved(log) : null)}])];
  if (finger.logs.length > 1) {
    out.append(make("h2", {}, "Drift"), ...plots, make("p", {class: "quiet"},
      finger.logs.every(log => log.day) ? "A square has a warning." : "Not every log has a day (in its name, or as the time since 1970), so logs stand in their order. A square has a warning."));
  }
  return out;
}

function main() {
  const data = JSON.parse(document.getElementById("data").textContent), rank = ["repair", "calibrate", "zero", "watch", "unchecked", "good"];
  data.fingers.sort((a, b) => rank.indexOf(a.verdict) - rank.indexOf(b.verdict));
  for (const finger of data.fingers) {
    finger.logs = finger.logs.map((log, i) => [log, i]).sort(([a, i], [b, k]) => (a.day < b.day ? -1 : a.day > b.day ? 1 : i - k)).map(([log]) => log);
  }
  const logs = data.fingers.flatMap(finger => finger.logs), amber = logs.filter(isAmber).length;
  document.getElementById("facts").textContent = `${logs.length} log${logs.length === 1 ? "" : "s"}, ${amber} with warnings; ` +
    `${data.fingers.length} finger${data.fingers.length === 1 ? "" : "s"}: ${data.fingers.map(f => `${f.name} ${f.verdict}`).join(", ")}`;
  document.getElementById("fingers").append(...data.fingers.map(section));
  if (data.bad_logs.length) {
    document.getElementById("fingers").append(make("h2", {}, "Logs that were left out"),
      tableOf([["log", "text"], ["reason", "text"]], data.bad_logs.map(bad => ({kind: "amber", cells: [bad.log, bad.reason]}))));
  }
  return data;
}

// For tests.
window.finray = Promise.resolve().then(main).catch(error => {
  document.getElementById("message").textContent = `This page cannot be shown: ${error.message}.`;
  document.getElementById("message").hidden = false;
  throw error;
});
