// Rows of a list that are ticked: the button below it is there for two to eight of them.

const [LEAST, MOST] = [2, 8];

for (const form of document.querySelectorAll("form[data-tick]")) {
  const button = form.querySelector("button[type=submit]");
  const said = form.querySelector("[data-ticked]");
  if (!button) continue;
  const count = () => {
    const ticked = form.querySelectorAll("input[name=fits]:checked").length;
    button.disabled = ticked < LEAST || ticked > MOST;
    said.textContent = ticked > MOST ? `${ticked} fits are ticked. Tick ${MOST} at most.`
      : ticked < LEAST ? `Tick ${LEAST} to ${MOST} fits.` : `${ticked} fits are ticked.`;
  };
  form.addEventListener("change", count);
  count();
}
