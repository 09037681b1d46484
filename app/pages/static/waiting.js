// A list in which jobs run is drawn anew when one of them ends, unless the reader is writing in it.

const ENDED = ["succeeded", "failed", "cancelled"];
const MOST = 3; // streams: a browser keeps few connections to one address

for (const { dataset } of [...document.querySelectorAll("[data-waits]")].slice(0, MOST)) {
  const events = new EventSource(dataset.waits);
  events.addEventListener("message", ({ data }) => {
    if (!ENDED.includes(JSON.parse(data).state)) return;
    events.close();
    if (!document.activeElement?.matches("input, select")) location.reload();
  });
}
