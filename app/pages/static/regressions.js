// Regressions: started by a form; the page of one that runs is drawn again while it runs.

import { guarded, send } from "./api.js";

const PAUSE = 2000; // ms

const form = document.querySelector("form[data-regression]");

form?.addEventListener("submit", (event) => {
  event.preventDefault();
  guarded(form.querySelector("button"), form.querySelector("[role=alert]"), async () => {
    const { tolerance, ...asked } = Object.fromEntries([...new FormData(form)].filter(([, value]) => value !== ""));
    const { data } = await send("POST", "/api/v1/regressions", { ...asked, tolerance: Number(tolerance ?? 0.001) });
    location.assign(`/regressions/${data.id}`);
  });
});

if (document.querySelector("[data-running]")) setTimeout(() => location.reload(), PAUSE);
