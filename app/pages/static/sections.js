// The sections of a page as tabs: one is shown at a time, and the address keeps which. Without this script all of them
// stand one below the other, and the tabs are links to them.

const tabs = [...document.querySelectorAll(".sections a")];
const sections = tabs.map((tab) => document.querySelector(tab.hash));
const picks = ["figure", "run", "low", "high"];  // a selection in the address is one of the residual analysis

const target = () => location.hash ? document.getElementById(decodeURIComponent(location.hash.slice(1))) : null;

function wanted() {
  const picked = new URLSearchParams(location.search);
  const first = picks.some((name) => picked.has(name)) ? document.querySelector("#residuals") : sections[0];
  return target()?.closest("[data-section]") ?? first;
}

function show(section) {
  for (const [place, one] of sections.entries()) {
    one.hidden = one !== section;
    if (one === section) tabs[place].setAttribute("aria-current", "true");
    else tabs[place].removeAttribute("aria-current");
  }
  document.dispatchEvent(new Event("sectionshown"));
}

// A link to a place inside a section shows it first, so that there is something to go to.
function follow() {
  show(wanted());
  const place = target();
  if (place?.tagName === "DETAILS") place.open = true;
  if (place && !sections.includes(place)) place.scrollIntoView();
}

if (tabs.length) {
  for (const tab of tabs) {
    tab.addEventListener("click", (event) => {
      event.preventDefault(); // no jump: the tabs stay where they are
      history.pushState(null, "", `${location.pathname}${location.search}${tab.hash}`);
      show(document.querySelector(tab.hash));
    });
  }
  addEventListener("hashchange", follow);
  addEventListener("popstate", follow);
  follow();
}
