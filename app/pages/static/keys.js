// Keys of every page: / goes to the search, ? shows the list of keys. In a field they are signs like any other.

const list = document.querySelector("#keys");

addEventListener("keydown", (event) => {
  const { key, target, ctrlKey, metaKey, altKey } = event;
  if (ctrlKey || metaKey || altKey || target.closest("input, textarea, select, [contenteditable]")) return;
  if (key === "?") list.showModal();
  if (key !== "/" || list.open) return;
  event.preventDefault();
  const field = document.querySelector("[data-search]");
  if (field) field.focus();
  else location.assign("/search");
});

if (location.pathname === "/search") document.querySelector("[data-search]")?.focus();
