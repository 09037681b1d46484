// Signals while they are zoomed or moved: the points that are there, stretched on the figure's own canvas.
// Vega needs a tenth of a second to draw eight panels. A frame of the screen is a sixtieth.

const MOST = 8; // stretches of points that are remembered: the first, of the whole record, always
const FINER = 4; // points of a stretch narrower than what is shown over so much are no sharper on the screen
const TICKS = 8; // numbers along the axis of time, about
let stretches = [];

// Keep the points of a definition of the figure, in place of those of the same stretch.
export function remember({ params, datasets }) {
  const [begin, end] = ["begin", "end"].map((wanted) => params.find(({ name }) => name === wanted).value);
  const others = stretches.filter((one) => one.begin !== begin || one.end !== end);
  const made = { begin, end, channels: Object.values(datasets).map(byRun) };
  stretches = others.length ? [others[0], ...others.slice(1).slice(2 - MOST), made] : [made];
}

// The points of a channel: for each run their times and values.
function byRun(rows) {
  const runs = {};
  for (const { t, y, r = "" } of rows) (runs[r] ??= []).push([t, y]);
  return runs;
}

// Draw what is remembered from `first` to `last`, the widest stretch below and the finer ones over it.
export function preview(view, first, last) {
  const canvas = view.container().querySelector("canvas");
  const ratio = canvas.width / parseFloat(canvas.style.width);
  const [x, y] = view.origin();
  const { left, top } = view.padding();
  const pen = canvas.getContext("2d");
  const panels = view.scenegraph().root.items[0].items.filter(({ name }) => /^concat_\d+_group$/.test(name)).map(({ items }) => items[0]);
  const shown = stretches.filter(({ begin, end }) => begin < last && end > first && (end - begin) * FINER >= last - first);
  shown.sort((a, b) => b.end - b.begin - (a.end - a.begin));
  pen.save();
  pen.setTransform(ratio, 0, 0, ratio, ratio * (left + x), ratio * (top + y));
  for (const [place, panel] of panels.entries()) {
    const time = view.scale(`concat_${place}_x`).copy().domain([first, last]);
    pen.save();
    pen.translate(panel.x, panel.y);
    for (const stretch of shown) drawStretch(pen, stretch, { view, place, panel, time });
    drawTicks(pen, { view, panel, time, numbered: panel === panels.at(-1) });
    pen.restore();
  }
  pen.restore();
}

// A panel from the begin of a stretch to its end: what was there goes, then the grid, then the lines.
function drawStretch(pen, { begin, end, channels }, { view, place, panel, time }) {
  const from = Math.max(0, time(begin)), to = Math.min(panel.width, time(end));
  const value = view.scale(`concat_${place}_y`);
  pen.save();
  pen.beginPath();
  pen.rect(from, 0, to - from, panel.height);
  pen.clip();
  pen.fillStyle = view.background();
  pen.fillRect(from, 0, to - from, panel.height);
  pen.strokeStyle = panel.stroke;
  pen.lineWidth = 1;
  pen.beginPath();
  for (const tick of time.ticks(TICKS)) lineTo(pen, time(tick), 0, time(tick), panel.height);
  for (const tick of value.ticks(4)) lineTo(pen, 0, value(tick), panel.width, value(tick));
  pen.strokeRect(0, 0, panel.width, panel.height);
  pen.stroke();
  pen.lineWidth = 1.2;
  for (const [run, points] of Object.entries(channels[place])) {
    pen.strokeStyle = run ? view.scale("color")(run) : colourOf(panel);
    pen.beginPath();
    for (const [t, y] of visible(points, time.domain())) pen.lineTo(time(t), value(y));
    pen.stroke();
  }
  pen.restore();
}

function lineTo(pen, fromX, fromY, toX, toY) {
  pen.moveTo(fromX, fromY);
  pen.lineTo(toX, toY);
}

// The points within, and one on each side.
function visible(points, [first, last]) {
  const begin = Math.max(0, points.findIndex(([t]) => t >= first) - 1);
  const end = points.findIndex(([t]) => t > last);
  return points.slice(begin, end < 0 ? undefined : end + 1);
}

// The colour of the one line of a panel.
function colourOf(panel) {
  return panel.items.find(({ marktype }) => marktype === "line")?.items[0]?.stroke;
}

// The axis of time below a panel: ticks, and numbers in the looks of those of the other axis.
function drawTicks(pen, { view, panel, time, numbered }) {
  const axes = panel.items.filter(({ role }) => role === "axis").flatMap(({ items }) => items[0].items);
  const { fill, font, fontSize } = axes.find(({ role }) => role === "axis-label").items[0];
  const ticks = time.ticks(TICKS), text = time.tickFormat(TICKS);
  pen.fillStyle = view.background();
  pen.fillRect(-1, panel.height + 1, panel.width + 2, 5);
  pen.strokeStyle = axes.find(({ role }) => role === "axis-tick").items[0].stroke;
  pen.beginPath();
  lineTo(pen, 0, panel.height + 0.5, panel.width, panel.height + 0.5);
  for (const tick of ticks) lineTo(pen, time(tick), panel.height, time(tick), panel.height + 5);
  pen.stroke();
  if (!numbered) return;
  pen.fillRect(-30, panel.height + 6, panel.width + 60, fontSize + 4);
  pen.fillStyle = fill;
  pen.font = `${fontSize}px ${font}`;
  pen.textAlign = "center";
  pen.textBaseline = "top";
  for (const tick of ticks) pen.fillText(text(tick), time(tick), panel.height + 8);
}
