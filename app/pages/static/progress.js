// A running job, live: stage, generation, best error and time left as the service sends them, and a way to stop it.

import { guarded, send } from "./api.js";
import { duration, errorWords, rounded, timeLeft } from "./words.js";

const ENDED = ["succeeded", "failed", "cancelled"];
const title = document.title;

function follow(live) {
  const bar = live.querySelector("progress");
  const state = document.querySelector("#job-state .state");
  const stage = live.querySelector("[data-stage]");
  const step = live.querySelector("[data-step]");
  const error = live.querySelector("[data-error]");
  const trace = live.querySelector(".trace polyline");
  const sight = live.querySelector("[data-sight]");
  const soFar = live.querySelector("[data-so-far]");
  const verdict = live.querySelector("[data-verdict]"); // none where the page shows it already
  const seen = [];

  function report(progress) {
    if (progress.stage) stage.textContent = progress.stage;
    if (progress.total) {
      bar.max = progress.total;
      bar.value = progress.done;
      step.textContent = `${progress.done} of ${progress.total}`;
      step.closest("span").hidden = progress.total < 2;
    }
    if (typeof progress.error === "number" && progress.error > 0) {
      error.textContent = errorWords(progress.error);
      error.closest("span").hidden = false;
      seen.push(progress.error);
      trace?.setAttribute("points", line(seen));
    }
    if (sight.hidden) list(sight, progress.expected);
    list(soFar, progress.added);
    if (verdict && progress.verdict) {
      verdict.lastElementChild.textContent = progress.verdict;
      verdict.hidden = false;
    }
  }

  // The clock goes on between two events, which come at least every 10 s.
  let heard = null;

  function tick() {
    if (!heard) return;
    const since = (performance.now() - heard.at) / 1000;
    say(live.querySelector("[data-elapsed]"), duration(heard.elapsed + since));
    const left = heard.left && Object.fromEntries(Object.entries(heard.left).map(([name, s]) => [name, s - since]));
    say(live.querySelector("[data-left]"), left ? timeLeft(left) : "not known yet");
    const far = left ? `${duration(rounded(left.seconds))} left` : bar.max > 1 && `${Math.floor(100 * bar.position)} %`;
    if (far) document.title = `${far} · ${title}`;
  }

  function clock({ state: now, elapsed, time_left: left }) {
    if (now === "running" && elapsed !== null) heard = { at: performance.now(), elapsed, left };
    tick();
  }

  const ticking = setInterval(tick, 1000);

  // Each event is the job as it is now.
  const events = new EventSource(live.dataset.events);

  function read(event) {
    const job = JSON.parse(event.data);
    if (state) {
      state.textContent = job.state;
      state.className = `state ${job.state}`;
    }
    report(job.progress);
    clock(job);
    if (!ENDED.includes(job.state)) return;
    clearInterval(ticking);
    events.close();
    sessionStorage.setItem("ended", job.state);
    location.reload();
  }

  for (const name of ["message", "queued", "running", ...ENDED]) events.addEventListener(name, read);

  const stops = (button, ask) =>
    button?.addEventListener("click", () =>
      guarded(button, live.querySelector("[role=alert]"), async () => {
        await ask();
        stage.textContent = "stopping at the next step";
      }),
    );
  stops(live.querySelector("[data-cancel]"), () => send("DELETE", live.dataset.job));
  stops(live.querySelector("[data-conclude]"), () => send("POST", `${live.dataset.job}/conclude`));
}

function say(place, text) {
  place.textContent = text;
  place.closest("span").hidden = false;
}

function list(paragraph, effects) {
  paragraph.lastElementChild.replaceChildren(...(effects ?? []).map(expectation));
  paragraph.hidden = !effects?.length;
}

// An effect that helps or promises to, and the error with it.
function expectation({ effect, error }) {
  const shown = document.createElement("span"), value = document.createElement("b");
  value.textContent = errorWords(error);
  shown.append(`${effect.replaceAll("_", " ")} `, value);
  return shown;
}

// Best error on a logarithmic scale over the reports so far, as the points of a line.
function line(seen) {
  const low = Math.log(Math.min(...seen)), high = Math.log(Math.max(...seen));
  const points = seen.map((value, place) => {
    const x = (600 * place) / Math.max(1, seen.length - 1);
    const y = high > low ? 96 - (88 * (Math.log(value) - low)) / (high - low) : 52;
    return `${x.toFixed(1)},${y.toFixed(1)}`;
  });
  return points.join(" ");
}

for (const live of document.querySelectorAll(".live[data-job]")) follow(live);
