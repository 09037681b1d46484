// Runs before the first paint: what is pressed before the page's scripts have come is heard once they have.
{
  const pressed = new Set();
  const wait = (event) => {
    const button = event.target.closest("button");
    if (!button) return;
    event.preventDefault();
    event.stopImmediatePropagation();
    pressed.add(button);
  };
  addEventListener("click", wait, true);
  addEventListener("DOMContentLoaded", () => {
    removeEventListener("click", wait, true);
    for (const button of pressed) button.click();
  });
}
