"use strict";
// The table of students: sort, search, filter by group. The state is in the address, so that "back" restores it.
(() => {
  const data = JSON.parse(document.getElementById("data").textContent), { groups } = data;
  const place = document.getElementById("class");
  if (!place) return;
  const find = document.getElementById("find"), shown = document.getElementById("shown");
  const body = document.getElementById("students").tBodies[0], rows = [...body.rows], numbers = new Map(rows.map((row, number) => [row, number]));
  const tables = [...document.querySelectorAll("table.sortable")];
  const compare = new Intl.Collator("en", { numeric: true, sensitivity: "base" }).compare;
  const letters = { ß: "ss", æ: "ae", œ: "oe", ø: "o", ł: "l", đ: "d", ð: "d", þ: "th", ı: "i" };
  const plain = (text) => text.toLowerCase().normalize("NFD").replace(/[\p{M}'’‘ʼ\-]/gu, "").replace(/[ßæœøłđðþı]/g, (letter) => letters[letter]);
  // Müller is found as Muller and as Mueller.
  const spellings = (text) => [plain(text), plain(text.normalize("NFC").replace(/[äöüø]/gi, "$&e"))];
  const more = document.getElementById("more");
  let words = null, names = null, state = new URLSearchParams(), most = 200; // rows: a browser needs 1 ms for ten

  function wordsOfRows() {
    const found = rows.map((row) => [...row.cells].map((cell) => cell.textContent));
    for (const [, word, numbers] of Object.values(groups)) {
      if (word) for (const number of numbers) found[number].push(word);
    }
    return found.map((texts) => spellings(texts.join(" ")).join(" "));
  }

  function namesOfRows() {
    const columns = [...document.getElementById("students").tHead.rows[0].cells].map((head) => head.dataset.column);
    const own = columns.flatMap((column, at) => ["name", "key"].includes(column) ? [at] : []);
    return rows.map((row) => spellings(own.map((at) => row.cells[at].textContent).join(" ")).join(" "));
  }

  function group() {
    const name = state.get("show");
    return name !== null && Object.hasOwn(groups, name) ? groups[name] : null;
  }

  function filter() {
    const wanted = (state.get("find") ?? "").split(/\s+/).filter(plain).map(spellings), chosen = group();
    if (wanted.length) [words, names] = [words ?? wordsOfRows(), names ?? namesOfRows()];
    const members = new Set(chosen ? chosen[2] : rows.keys());
    const holding = (texts) => rows.filter((row, number) => members.has(number) && wanted.every((word) => word.some((spelling) => texts[number].includes(spelling))));
    // A name comes first: Link is also a part of criteria, which find others only where no name has the word.
    const named = wanted.length ? holding(names) : [], others = wanted.length ? holding(words) : rows.filter((_, number) => members.has(number));
    const found = new Set(named.length ? named : others), left = others.length - found.size;
    let count = 0;
    for (const row of body.rows) row.hidden = !found.has(row) || ++count > most;
    showRobots(data, [...body.rows].filter((row) => !row.hidden).map((row) => [numbers.get(row), row]));
    const all = `${rows.length} student${rows.length === 1 ? "" : "s"}`;
    shown.textContent = found.size === rows.length ? all : `${found.size} of ${all}${chosen ? `: ${chosen[0]}` : ""}${left ? ` by name; ${left} more elsewhere in the table` : ""}`;
    more.hidden = found.size <= most;
    for (const button of document.querySelectorAll("button.show")) {
      button.setAttribute("aria-pressed", String(button.dataset.shows === state.get("show")));
    }
  }

  function sort(table) {
    const wanted = state.get(table.id) ?? table.dataset.first, column = wanted.replace(/^-/, "");
    const heads = [...table.tHead.rows[0].cells], index = heads.findIndex((head) => head.dataset.column === column);
    if (index < 0 || table.dataset.sorted === wanted) return;
    const sign = wanted.startsWith("-") ? -1 : 1, isNumber = heads[index].classList.contains("number");
    const keys = new Map();
    for (const row of table.tBodies[0].rows) {
      const text = row.cells[index].textContent.trim();
      keys.set(row, isNumber ? parseFloat(text) : text);
    }
    const isEmpty = (key) => key === "" || Number.isNaN(key);
    const order = (a, b) => (isEmpty(a) || isEmpty(b) ? isEmpty(a) - isEmpty(b) : sign * (isNumber ? a - b : compare(a, b)));
    table.tBodies[0].append(...[...keys.keys()].sort((a, b) => order(keys.get(a), keys.get(b))));
    heads.forEach((head) => head.removeAttribute("aria-sort"));
    heads[index].setAttribute("aria-sort", sign > 0 ? "ascending" : "descending");
    table.dataset.sorted = wanted;
  }

  function apply() {
    if (find.value !== (state.get("find") ?? "")) find.value = state.get("find") ?? "";
    tables.forEach(sort);
    filter();
  }

  function change(name, value, isNew) {
    value ? state.set(name, value) : state.delete(name);
    apply();
    const address = `#${String(state) || "class"}`;
    isNew ? (location.hash = address) : history.replaceState(null, "", address);
  }

  function read() {
    const text = location.hash.slice(1);
    if (text && !text.includes("=") && text !== "class") return; // a link within the page
    state = new URLSearchParams(text === "class" ? "" : text);
    apply();
  }

  function button(parent, name) {
    const made = document.createElement("button");
    made.type = "button";
    made.className = name;
    made.append(...parent.childNodes);
    parent.append(made);
    return made;
  }

  for (const parent of document.querySelectorAll("[data-group]")) {
    const made = button(parent, "show");
    made.dataset.shows = parent.dataset.group;
    made.title = "Show these students";
    made.addEventListener("click", () => {
      change("show", state.get("show") === made.dataset.shows ? "" : made.dataset.shows, true);
      place.scrollIntoView();
      shown.focus({ preventScroll: true });
    });
  }
  for (const table of tables) {
    table.dataset.first = table.querySelector("[aria-sort]").dataset.column;
    table.dataset.sorted = table.dataset.first;
    for (const head of table.tHead.rows[0].cells) {
      button(head, "sort").addEventListener("click", () => {
        const column = head.dataset.column;
        change(table.id, table.dataset.sorted === column ? `-${column}` : column, false);
      });
    }
  }
  function showAll() {
    state.delete("show");
    change("find", "", false);
  }
  shown.tabIndex = -1;
  find.form.hidden = false;
  find.form.addEventListener("submit", (event) => event.preventDefault());
  find.addEventListener("input", () => change("find", find.value, false));
  document.getElementById("all").addEventListener("click", showAll);
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === "/" && event.target !== find) {
      event.preventDefault();
      find.focus();
    } else if (event.key === "Escape" && event.target === find) {
      event.preventDefault(); // the browser would empty the box
      shown.focus();
    } else if (event.key === "Escape") {
      showAll();
    }
  });
  function showAllRows() {
    most = Infinity;
    filter();
  }
  function openForPrint() {
    showAllRows();
    for (const one of document.querySelectorAll("details")) one.open = true;
  }
  more.addEventListener("click", showAllRows);
  addEventListener("beforeprint", openForPrint);
  addEventListener("hashchange", read);
  read();
  if (state.has("show")) place.scrollIntoView();
})();
