// Signals are zoomed and moved: the points that are there follow at once, and at rest the service sends those of what is shown.

import { guarded, send } from "./api.js";
import { preview, remember } from "./preview.js";

const section = document.querySelector("#signals");
const figure = section.querySelector(".figure");
const plot = figure.querySelector(".plot");
const { start: from, seconds: long } = figure.querySelector("form").elements;
const whole = Number(section.dataset.duration), shortest = Number(section.dataset.shortest);
const REST = 100; // ms after the last movement until the points are asked for
const STEP = 1.25; // by how much a turn of the wheel or a key zooms
let rest, held, frame;

const shown = () => {
  const start = Number(from.value);
  return { start, seconds: long.value === "" ? whole - start : Number(long.value) };
};

function follow() {
  cancelAnimationFrame(frame);
  frame = undefined;
  const { start, seconds } = shown();
  if (figure.view) preview(figure.view, start, start + seconds);
}

// Points that come are on the screen at once. Vega follows, with axes of these points.
figure.addEventListener("arrived", ({ detail }) => {
  remember(detail);
  follow();
});

function ask() {
  delete figure.dataset.drawn; // the canvas shows something else by now
  from.form.dispatchEvent(new Event("change"));
}

function show(start, seconds) {
  const length = Math.min(whole, Math.max(seconds, shortest));
  const first = Math.min(Math.max(start, 0), whole - length);
  from.value = first ? Number(first.toPrecision(9)) : "";
  long.value = length < whole ? Number(length.toPrecision(9)) : "";
  frame ??= requestAnimationFrame(follow); // turns of a wheel come faster than frames
  clearTimeout(rest);
  rest = setTimeout(ask, REST);
}

function zoom(factor, share = 0.5) {
  const { start, seconds } = shown();
  const length = Math.min(whole, Math.max(seconds * factor, shortest));
  show(start + share * (seconds - length), length);
}

// Where the pointer is along the axis of time: 0 at its begin, 1 at its end; undefined before the first drawing.
function place(event) {
  const canvas = plot.querySelector("canvas");
  if (!canvas || !figure.view) return undefined;
  const { view } = figure;
  const panel = view.scenegraph().root.items[0].items.find(({ marktype }) => marktype === "group").items[0];
  return (event.clientX - canvas.getBoundingClientRect().left - view.padding().left - view.origin()[0] - panel.x) / panel.width;
}

plot.addEventListener("wheel", (event) => {
  const share = place(event);
  if (!(share >= 0 && share <= 1) || event.deltaY === 0) return;
  event.preventDefault();
  zoom(event.deltaY < 0 ? 1 / STEP : STEP, share);
}, { passive: false });
plot.addEventListener("pointerdown", (event) => {
  const share = place(event);
  if (!(share >= 0 && share <= 1) || event.button !== 0) return;
  held = { share, ...shown() };
  plot.setPointerCapture(event.pointerId);
});
plot.addEventListener("pointermove", (event) => {
  if (held) show(held.start - (place(event) - held.share) * held.seconds, held.seconds);
});
for (const end of ["pointerup", "pointercancel"]) plot.addEventListener(end, () => (held = undefined));
plot.addEventListener("keydown", ({ key }) => {
  const { start, seconds } = shown();
  if (key === "+") zoom(1 / STEP);
  if (key === "-") zoom(STEP);
  if (key === "ArrowLeft") show(start - seconds / 10, seconds);
  if (key === "ArrowRight") show(start + seconds / 10, seconds);
  if (key === "0") show(0, whole);
});

// What is shown becomes the rows of the run in its file, or its validation data: counted on from the rows that it has.
const form = document.querySelector("#keep-range");
form?.addEventListener("submit", (event) => {
  event.preventDefault();
  const splits = event.submitter?.value === "split";
  guarded(event.submitter ?? form.querySelector("button"), form.querySelector("[role=alert]"), async () => {
    const { run, rate, samples, description, revisions } = form.dataset;
    const { data } = await send("GET", description);
    const entry = data.runs.find(({ id }) => String(id) === run) ?? data.runs.find(({ id, split }) => split && run.startsWith(`${id}.`));
    if (!entry) throw new Error("This run is one output of a record. Edit the record on the page of the data set.");
    if (entry.time?.resample) throw new Error("This run is resampled. Edit its samples on the page of the data set.");
    if (entry.split) throw new Error("This run already has validation samples. Edit them on the page of the data set.");
    const { start, seconds } = shown();
    const before = Number(entry.rows?.[0] ?? 0);
    const first = Math.round(start * rate), end = Math.min(Number(samples), Math.round((start + seconds) * rate));
    const range = [before + first, before + end], gap = form.elements.gap.value.trim();
    const change = splits ? { split: { validation: range, ...(gap && { gap }) } } : { rows: range };
    change.trend = form.elements.trend.value;
    const made = await send("POST", revisions, { runs: { [run]: change } });
    location.assign(`/matrices/${made.data.id}`);
  });
});
