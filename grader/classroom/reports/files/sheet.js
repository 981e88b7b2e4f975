"use strict";
// The contact sheet: small pictures of the robots in the rows of the table, as it is filtered and
// sorted. Robots of equal work are framed.

/**
 * What the page has: of each row the number of its picture, -1 without one; of each picture the
 * colours and outlines of its faces; groups of rows, each with its label, a word and its members.
 * @typedef {{robots: number[], stills: [string, string][][], size: [number, number],
 *   groups: {[name: string]: [string, string, number[]]}}} SheetData
 */

/**
 * Show the robots of rows.
 * @param {SheetData} data
 * @param {[number, HTMLTableRowElement][]} shown rows with their numbers
 */
function showRobots({ robots, stills, size, groups }, shown) {
  const list = document.getElementById("stills");
  if (!list) {
    return;
  }
  const svg = (/** @type {string} */ name, /** @type {{[name: string]: string}} */ attributes) => {
    const element = document.createElementNS("http://www.w3.org/2000/svg", name);
    Object.entries(attributes).forEach(([key, value]) => element.setAttribute(key, value));
    return element;
  };
  const equal = Object.entries(groups)
    .filter(([name]) => name.startsWith("same-"))
    .map(([, [, , members]]) => new Set(members));
  const items = shown.flatMap(([number, row]) => {
    const still = stills[robots[number]];
    const head = row.cells[0];
    const address = head.querySelector("a")?.getAttribute("href");
    if (!address) {
      return [];
    }
    const [item, link] = [document.createElement("li"), document.createElement("a")];
    link.href = address;
    const sheet = svg("svg", { viewBox: `0 0 ${size.join(" ")}`, "aria-hidden": "true" });
    sheet.append(...(still || []).map(([fill, d]) => svg("path", { fill, d })));
    const grade = row.querySelector("td.grade")?.textContent || "";
    link.append(sheet, [head.textContent, grade].filter(Boolean).join(", "));
    item.append(link);
    const work = equal.findIndex((members) => members.has(number));
    if (work >= 0) {
      item.className = "equal";
      link.append(` (equal work ${work + 1})`);
    }
    return [item];
  });
  list.replaceChildren(...items);
}
