// Streams while a test runs: the last ten seconds of each on canvases, numbers, alarms, marks, and a recording.

import { guarded, send } from "./api.js";

const API = "/api/v1/live";
const BINS = 64; // a second, as the service sends them
const SHOWN = 10 * BINS;
const MOST = 4; // streams at once: a browser holds six connections to one service
const LOOK = 2000; // ms between two looks for new streams
const SAID = 500; // ms between two changes of the numbers: they can be read
const COLUMNS = ["t", "r_low", "r_high", "y_low", "y_high", "tau", "std_tau", "gain", "std_gain", "nis"];
const SURE = 1.96; // standard deviations of a 95 % band

const model = document.querySelector("#stream");
const list = document.querySelector("#streams");
const none = document.querySelector("#none");
const streams = new Map();
let colours = {};

function readColours() {
  const style = getComputedStyle(document.documentElement);
  const of = (name) => style.getPropertyValue(name).trim();
  const dark = matchMedia("(prefers-color-scheme: dark)").matches;
  const theme = document.documentElement.dataset.theme ?? (dark ? "dark" : "light");
  const series = theme === "dark" ? ["#4fb3ee", "#ff8a47"] : ["#0072b2", "#d55e00"]; // as the figures have them
  colours = { ink: of("--ink"), faint: of("--faint"), line: of("--line"), bad: of("--bad"), series };
  for (const stream of streams.values()) stream.dirty = stream.state !== undefined;
}

// The last values of every column, oldest first.
class Window {
  constructor() {
    this.of = Object.fromEntries(COLUMNS.map((name) => [name, []]));
  }
  add(bins) {
    for (const name of COLUMNS) {
      const column = this.of[name];
      for (const value of bins[name]) column.push(value);
      if (column.length > SHOWN) column.splice(0, column.length - SHOWN);
    }
  }
}

// A panel: what is drawn, from columns; a band is [low, high], and so is a signal within a bin.
const PANELS = {
  signals: (of) => ({ factor: 1e3, areas: [[of.r_low, of.r_high], [of.y_low, of.y_high]], lines: [] }),
  tau: (of) => banded(of.tau, of.std_tau, 1e3),
  gain: (of) => banded(of.gain, of.std_gain, 1),
  nis: (of) => ({ factor: 1, areas: [], lines: [of.nis], zero: true, level: 1 }),
};

function banded(values, deviations, factor) {
  const to = (sign) => values.map((value, i) => value + sign * SURE * deviations[i]);
  return { factor, areas: [], band: [to(-1), to(1)], lines: [values] };
}

function draw(canvas, { factor, areas, lines, band, zero, level }, { t, marks, alarms }) {
  const ratio = devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  const pen = canvas.getContext("2d");
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, width, height);
  if (!t.length) return;
  const left = 52, bottom = height - 18, top = 6, end = t[t.length - 1], begin = end - SHOWN / BINS;
  const [low, high] = range([...areas.flat(), ...(band ?? []), ...lines], factor, zero, level);
  const x = (at) => left + ((at - begin) / (end - begin)) * (width - left - 4);
  const y = (value) => bottom - ((factor * value - low) / (high - low)) * (bottom - top);
  axes(pen, { left, bottom, top, width, low, high, begin, end, x, y: (value) => y(value / factor) });
  pen.save();
  pen.beginPath();
  pen.rect(left, 0, width - left, bottom);
  pen.clip();
  for (const [places, colour] of [[marks, colours.faint], [alarms, colours.bad]]) {
    pen.strokeStyle = colour;
    pen.setLineDash([3, 3]);
    for (const { at } of places) if (at > begin) stroke(pen, [[x(at), top], [x(at), bottom]]);
    pen.setLineDash([]);
  }
  if (level !== undefined) {
    pen.strokeStyle = colours.faint;
    stroke(pen, [[left, y(level)], [width, y(level)]]);
  }
  if (band) fill(pen, t, band, x, y, colours.series[0]);
  areas.forEach((ends, place) => strip(pen, t, ends, x, y, colours.series[place]));
  for (const values of lines) {
    pen.strokeStyle = colours.series[0];
    pen.lineWidth = 1.5;
    line(pen, t, values, x, y);
  }
  pen.restore();
}

function range(columns, factor, zero, level) {
  let low = Infinity, high = -Infinity;
  for (const column of columns) {
    for (const value of column) {
      if (value === null) continue;
      if (factor * value < low) low = factor * value;
      if (factor * value > high) high = factor * value;
    }
  }
  if (level !== undefined) [low, high] = [Math.min(low, factor * level), Math.max(high, factor * level)];
  if (zero) [low, high] = [0, Math.min(high, 10)];
  if (!(low < high)) [low, high] = [Number.isFinite(low) ? low - 1 : 0, Number.isFinite(low) ? low + 1 : 1];
  const room = 0.08 * (high - low);
  return [zero ? 0 : low - room, high + room];
}

// The numbers of an axis: multiples of 1, 2 or 5 times a power of ten, with the decimals that tell them apart.
function ticks(low, high) {
  const power = 10 ** Math.floor(Math.log10((high - low) / 2));
  const step = [5, 2, 1].map((times) => times * power).find((one) => (high - low) / one >= 2) ?? power;
  const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9)), found = [];
  for (let value = Math.ceil(low / step) * step; value <= high; value += step) found.push([value, value.toFixed(decimals).replace(/^-(?=[0.]*$)/, "")]);
  return found;
}

function axes(pen, { left, bottom, top, width, low, high, begin, end, x, y }) {
  pen.strokeStyle = colours.line;
  pen.fillStyle = colours.faint;
  pen.lineWidth = 1;
  pen.font = "11px system-ui, sans-serif";
  pen.textAlign = "right";
  pen.textBaseline = "middle";
  for (const [value, text] of ticks(low, high)) {
    stroke(pen, [[left, y(value)], [width, y(value)]]);
    pen.fillText(text.replace("-", "−"), left - 6, Math.min(Math.max(y(value), 7), bottom - 2));
  }
  pen.textAlign = "center";
  for (let at = Math.max(0, Math.ceil(begin / 2) * 2); at <= end; at += 2) {
    stroke(pen, [[x(at), top], [x(at), bottom]]);
    if (x(at) < width - 14) pen.fillText(`${at} s`, x(at), bottom + 10);
  }
}

function stroke(pen, points) {
  pen.beginPath();
  points.forEach(([x, y], i) => (i ? pen.lineTo(x, y) : pen.moveTo(x, y)));
  pen.stroke();
}

function line(pen, t, values, x, y) {
  pen.beginPath();
  let drawn = false;
  values.forEach((value, i) => {
    if (value === null) drawn = false;
    else if (drawn) pen.lineTo(x(t[i]), y(value));
    else pen.moveTo(x(t[i]), y(value)), (drawn = true);
  });
  pen.stroke();
}

// A signal from its smallest to its largest value in each bin, a rectangle a bin: drawn in a tenth of a line's time.
function strip(pen, t, [low, high], x, y, colour) {
  pen.fillStyle = colour;
  let above, below; // of the bin before: the two meet
  t.forEach((at, i) => {
    if (low[i] === null || high[i] === null) return (above = below = undefined);
    const left = Math.floor(x(at - 1 / BINS)), top = y(high[i]), bottom = y(low[i]);
    const from = Math.floor(Math.min(top, below ?? top)), to = Math.ceil(Math.max(bottom, above ?? bottom));
    pen.fillRect(left, from, Math.max(1, Math.floor(x(at)) - left), Math.max(1.5, to - from));
    [above, below] = [top, bottom];
  });
}

// The area between two columns.
function fill(pen, t, [low, high], x, y, colour) {
  pen.globalAlpha = 0.2;
  pen.fillStyle = colour;
  pen.beginPath();
  const known = [...t.keys()].filter((i) => low[i] !== null && high[i] !== null);
  known.forEach((i, n) => (n ? pen.lineTo(x(t[i]), y(high[i])) : pen.moveTo(x(t[i]), y(high[i]))));
  for (const i of known.reverse()) pen.lineTo(x(t[i]), y(low[i]));
  pen.fill();
  pen.globalAlpha = 1;
}

class Stream {
  constructor(name) {
    this.name = name;
    this.window = new Window();
    this.dirty = this.inSight = false;
    this.drawn = this.said = 0; // ms
    this.at = model.content.firstElementChild.cloneNode(true);
    this.at.querySelector("h2").textContent = name;
    this.at.dataset.name = name;
    this.canvases = [...this.at.querySelectorAll("canvas")];
    for (const canvas of this.canvases) canvas.setAttribute("aria-label", `${canvas.dataset.title}, stream ${name}`);
    for (const field of this.at.querySelectorAll("[data-id]")) field.id = `${field.dataset.id}-${name}`;
    for (const label of this.at.querySelectorAll("[data-for]")) label.htmlFor = `${label.dataset.for}-${name}`;
    this.act();
    list.append(this.at);
    this.source = new EventSource(`${API}/${name}/events`);
    this.source.onmessage = ({ data }) => this.hear(JSON.parse(data));
  }

  hear({ state, bins }) {
    if (this.state && state.seconds < this.state.seconds) this.window = new Window(); // another stream of this name
    this.state = state;
    this.window.add(bins);
    this.dirty = true;
    if (state.ended) this.source.close();
  }

  // Draws what is new; numbers and lists change less often.
  show(now) {
    const of = this.window.of;
    const about = { t: of.t, marks: this.state.marks, alarms: this.state.alarms };
    for (const canvas of this.canvases) draw(canvas, PANELS[canvas.dataset.panel](of), about);
    this.dirty = false;
    this.drawn = now;
    if (now - this.said > SAID || this.state.ended) {
      this.said = now;
      this.tell();
    }
  }

  tell() {
    const { of } = this.window, last = (name) => of[name][of[name].length - 1];
    const put = (name, text) => {
      const place = this.at.querySelector(`[data-value=${name}]`);
      if (place.textContent !== text) place.textContent = text;
    };
    const { on, recording, ended, seconds, alarms, marks } = this.state;
    const fails = on.includes("not first order");
    put("state", ended ? `ended after ${seconds.toFixed(1)} s` : `running for ${seconds.toFixed(0)} s`);
    if (of.t.length) {
      put("tau", `${(1e3 * last("tau")).toFixed(2)} ± ${(1e3 * SURE * last("std_tau")).toFixed(2)} ms`);
      put("gain", `${last("gain").toFixed(4)} ± ${(SURE * last("std_gain")).toFixed(4)}`);
      const nis = last("nis");
      put("nis", `${fails ? "fails: not first order" : "passes"}${nis === null ? "" : `, mean ${nis.toFixed(2)} (1 is right)`}`);
    }
    put("alarm", on.length ? on.join(", ") : "none");
    this.at.querySelector("[data-value=alarm]").classList.toggle("bad", on.length > 0);
    put("recording", recording ? `${recording.on ? "recording" : recording.full ? "full" : "ended"}, ${(recording.samples / this.state.sample_rate).toFixed(1)} s` : "none");
    const record = this.at.querySelector("[data-live-record]"); // none for who may only look
    if (record) {
      record.textContent = recording?.on ? "End the recording" : "Record";
      record.disabled = ended;
      this.at.querySelector("[data-live-keep]").hidden = !recording || recording.on || !recording.samples;
    }
    this.rows(alarms.map(({ at, text, begins }) => [at, `${begins ? "alarm" : "end of alarm"}: ${text}`]).concat(marks.map(({ at, text }) => [at, text])));
  }

  // Alarms and marks, the newest first.
  rows(said) {
    const key = JSON.stringify(said);
    if (key === this.listed) return;
    this.listed = key;
    const rows = said.sort(([a], [b]) => b - a).map(([at, text]) => {
      const row = document.createElement("li");
      row.textContent = `${at.toFixed(2)} s: ${text}`;
      return row;
    });
    this.at.querySelector("[data-said]").replaceChildren(...rows);
  }

  act() {
    const wrong = this.at.querySelector("[role=alert]");
    const mark = this.at.querySelector("[data-live-mark]");
    mark?.addEventListener("submit", (event) => {
      event.preventDefault();
      guarded(mark.querySelector("button"), wrong, async () => {
        await send("POST", `${API}/${this.name}/marks`, { text: mark.elements.text.value });
        mark.reset();
      });
    });
    const record = this.at.querySelector("[data-live-record]");
    record?.addEventListener("click", () =>
      guarded(record, wrong, () => send("PUT", `${API}/${this.name}/recording`, { on: !this.state?.recording?.on })),
    );
    const keep = this.at.querySelector("[data-live-keep]");
    keep?.addEventListener("submit", (event) => {
      event.preventDefault();
      guarded(keep.querySelector("button"), wrong, async () => {
        const { serial, run } = keep.elements;
        const { data } = await send("POST", `${API}/${this.name}/recording`, { serial: serial.value.trim(), run: run.value.trim() });
        location.assign(`/matrices/${data.id}`);
      });
    });
  }
}

async function look() {
  const { data } = await send("GET", API).catch(() => ({ data: { items: [] } }));
  for (const { name, ended, seconds } of data.items) {
    const known = streams.get(name);
    if (known?.state?.ended && !ended) { // begun anew under its name
      known.at.remove();
      streams.delete(name);
    }
    if (!streams.has(name) && streams.size < MOST && (!ended || seconds > 0)) {
      const made = new Stream(name);
      streams.set(name, made);
      sight.observe(made.at);
    }
  }
  none.hidden = streams.size > 0;
}

// One stream a frame, of those in sight the one that was drawn longest ago: no frame waits for another stream.
function frame(now) {
  const waiting = [...streams.values()].filter(({ dirty, inSight }) => dirty && inSight);
  waiting.sort((a, b) => a.drawn - b.drawn)[0]?.show(now);
  requestAnimationFrame(frame);
}

const sight = new IntersectionObserver((entries) => {
  for (const { target, isIntersecting } of entries) {
    const stream = streams.get(target.dataset.name);
    if (stream) stream.inSight = isIntersecting;
  }
});

readColours();
new MutationObserver(readColours).observe(document.documentElement, { attributeFilter: ["data-theme"] });
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", readColours);
look();
setInterval(look, LOOK);
requestAnimationFrame(frame);
