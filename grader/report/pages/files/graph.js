"use strict";
// The page of a graph: what is near is marked on hover, a click opens a node, and a filter dims the rest.

{
  const find = (/** @type {string} */ id) =>
    /** @type {HTMLElement} */ (document.getElementById(id));
  const items = /** @type {SVGGElement[]} */ ([...document.querySelectorAll(".item")]);
  const arrows = /** @type {SVGPathElement[]} */ ([...document.querySelectorAll(".arrow")]);
  /** Return what an item is, as its title says. @param {SVGGElement} item */
  const nameOf = (item) => item.querySelector("title")?.textContent || "";
  const filter = /** @type {HTMLInputElement} */ (find("filter"));

  /** Mark the arrows of an item, and say what it is. @param {SVGGElement | null} item */
  const mark = (item) => {
    for (const arrow of arrows) {
      const ends = [arrow.dataset.from, arrow.dataset.to];
      arrow.classList.toggle("near", item !== null && ends.includes(item.id));
    }
    find("about").textContent = item ? nameOf(item) : "";
  };

  /** Return the nodes of an item: itself, or those that its arrows lead to. @param {SVGGElement} item */
  const nodesOf = (item) => {
    if (item.classList.contains("node")) {
      return [item.id];
    }
    const ends = arrows.map((arrow) => [arrow.dataset.from || "", arrow.dataset.to || ""]);
    return ends
      .filter((pair) => pair.includes(item.id))
      .map((pair) => pair.find((id) => id !== item.id) || "");
  };

  /** Open the cards of an item's nodes, and show the first. @param {SVGGElement} item */
  const open = (item) => {
    const cards = nodesOf(item).flatMap((id) => document.getElementById(`card-${id}`) || []);
    for (const card of cards) {
      card.setAttribute("open", "");
    }
    if (cards.length) {
      cards[0].scrollIntoView({ block: "start" });
      cards[0].querySelector("summary")?.focus();
    }
  };

  for (const item of items) {
    item.setAttribute("tabindex", "0");
    item.setAttribute("role", "button");
    item.setAttribute("aria-label", nameOf(item));
    item.addEventListener("mouseenter", () => mark(item));
    item.addEventListener("mouseleave", () => mark(null));
    item.addEventListener("focus", () => mark(item));
    item.addEventListener("click", () => open(item));
    item.addEventListener("keydown", (event) => {
      if (event.key === "Enter" || event.key === " ") {
        event.preventDefault();
        open(item);
      }
    });
  }
  // Buttons inside of a picture are not announced.
  document.querySelector(".drawing svg")?.setAttribute("role", "group");

  filter.addEventListener("input", () => {
    const wanted = filter.value.toLowerCase();
    const isNamed = (/** @type {SVGGElement} */ item) =>
      nameOf(item).toLowerCase().includes(wanted);
    const named = new Set(items.filter(isNamed).map((item) => item.id));
    const shown = new Set(named);
    for (const arrow of arrows) {
      const ends = [arrow.dataset.from || "", arrow.dataset.to || ""];
      const isNear = ends.some((id) => named.has(id));
      arrow.classList.toggle("dim", !isNear);
      ends.filter(() => isNear).forEach((id) => shown.add(id));
    }
    for (const item of items) {
      item.classList.toggle("dim", !shown.has(item.id));
      const card = document.getElementById(`card-${item.id}`);
      if (card) {
        card.hidden = !shown.has(item.id);
      }
    }
  });

  const TABS = ["graph", "frames"];
  /** Show one of the two parts. @param {string} shown */
  const choose = (shown) => {
    for (const tab of TABS) {
      find(tab).hidden = tab !== shown;
      find(`tab-${tab}`).setAttribute("aria-pressed", String(tab === shown));
    }
  };
  for (const tab of TABS) {
    find(`tab-${tab}`).addEventListener("click", () => choose(tab));
  }
  choose("graph");
}
