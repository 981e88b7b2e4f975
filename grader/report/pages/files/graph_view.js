"use strict";
// The page of a graph in `grader view`: it waits for the next version, and is loaded again, with its tab and filter.

{
  const find = (/** @type {string} */ id) =>
    /** @type {HTMLElement} */ (document.getElementById(id));
  const { number, address } = JSON.parse(find("data").textContent || "{}").view;
  const filter = /** @type {HTMLInputElement} */ (find("filter"));
  const KEY = "grader-graph";

  /** Keep what is chosen, for the page that follows. */
  const keep = () => {
    const tab = find("frames").hidden ? "graph" : "frames";
    const open = [...document.querySelectorAll("details[open]")].map((card) => card.id);
    sessionStorage.setItem(KEY, JSON.stringify({ tab, filter: filter.value, open }));
  };
  const restore = () => {
    const kept = JSON.parse(sessionStorage.getItem(KEY) || "null");
    sessionStorage.removeItem(KEY);
    if (kept) {
      find(`tab-${kept.tab}`).click();
      filter.value = kept.filter;
      filter.dispatchEvent(new Event("input"));
      for (const id of kept.open) {
        document.getElementById(id)?.setAttribute("open", "");
      }
    }
  };
  const follow = async () => {
    for (;;) {
      const answer = await fetch(`changes/${number}/${address}`);
      const change = await answer.json();
      if (change.isEnded) {
        return;
      }
      if (change.page) {
        keep();
        location.reload();
        await new Promise(() => {}); // the page goes
      }
    }
  };

  restore();
  follow()
    .catch(() => {}) // there is no connection
    .then(() => {
      find("view-ended").hidden = false;
    });
}
