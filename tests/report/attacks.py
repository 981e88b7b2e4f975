"""Text that attacks a page, and a class whose students write it wherever they can, graded, marked and exported."""

import csv
from pathlib import Path
from typing import NamedTuple

from tests.classroom.gradebooks import grader
from tests.report.hostile import SLOTS, write_submission

_RUN = "document.title='run'"
# Each does something where a page forgets to escape: between tags, in quotes, in a script, in a style, in an address, in a
# template, in a name that the page's own script looks up.
ATTACKS = (
    f"<script>{_RUN}</script>",
    f"</script><script>{_RUN}</script>",
    f"<ScRiPt >{_RUN}</sCrIpT\t>",
    f"<scr<script>ipt>{_RUN}</scr</script>ipt>",
    f"<script/x>{_RUN}</script>",
    f"<script>{_RUN}//",
    "<script src=//evil.example/x.js></script>",
    f"<img src=x onerror={_RUN}>",
    f'<img src=x onerror="{_RUN}">',
    f"<img/src='x'/onerror={_RUN}>",
    f"<img src=x:alert(1) onerror=eval(src) alt='{_RUN}'>",
    f"<image href=x onerror={_RUN}>",
    f"<svg onload={_RUN}>",
    f'"><svg/onload={_RUN}>',
    f"<svg><script>{_RUN}</script></svg>",
    f"<svg><script>{_RUN.replace(chr(39), '&#39;')}</script></svg>",
    f"<svg><animate onbegin={_RUN} attributeName=x dur=1s>",
    f"<svg><a xlink:href='javascript:{_RUN}'><text y=20>x</text></a></svg>",
    f"<svg><foreignObject><body onload={_RUN}></foreignObject></svg>",
    "<svg><use href='data:image/svg+xml,&lt;svg id=x xmlns=http://www.w3.org/2000/svg&gt;&lt;/svg&gt;#x'></svg>",
    f"<math><mtext><table><mglyph><style><!--</style><img title='--&gt;&lt;img src=1 onerror={_RUN}&gt;'>",
    f"<body onload={_RUN}>",
    f"<details open ontoggle={_RUN}>x</details>",
    f"<input autofocus onfocus={_RUN}>",
    f"<select autofocus onfocus={_RUN}></select>",
    f"<video><source onerror={_RUN}></video>",
    f"<audio src=x onerror={_RUN}>",
    f"<marquee onstart={_RUN}>x</marquee>",
    f"<a href='javascript:{_RUN}'>x</a>",
    f"<a href=' java&#x0A;script:{_RUN}'>x</a>",
    f"<iframe src='javascript:parent.{_RUN}'></iframe>",
    f"<iframe srcdoc='<script>parent.{_RUN}</script>'></iframe>",
    "<object data=//evil.example/x></object><embed src=//evil.example/x>",
    f"<form action='javascript:{_RUN}'><button autofocus>x</button></form>",
    f"<button formaction='javascript:{_RUN}'>x</button>",
    "<base href=//evil.example/>",
    "<meta http-equiv=refresh content='0;url=//evil.example/'>",
    "<link rel=stylesheet href=//evil.example/x.css>",
    "<style>body{display:none} @import '//evil.example/x.css';</style>",
    "<div style='background:url(//evil.example/x.png);position:fixed;inset:0'>x</div>",
    f"<template><script>{_RUN}</script></template>",
    f"</title><script>{_RUN}</script>",
    f"</style><script>{_RUN}</script>",
    f"</textarea><script>{_RUN}</script>",
    f"</noscript></xmp></plaintext><script>{_RUN}</script>",
    f"--><script>{_RUN}</script><!--",
    f"--!><img src=x onerror={_RUN}>",
    f"]]><script>{_RUN}</script><![CDATA[",
    f"<![CDATA[<script>{_RUN}</script>]]>",
    f"<?xml-stylesheet href='javascript:{_RUN}'?>",
    f'" autofocus onfocus="{_RUN}" x="',
    f"' autofocus onfocus='{_RUN}' x='",
    f"` onmouseover={_RUN} x=`",
    f"x onmouseover={_RUN}",
    f'" style="animation-name:x" onanimationstart="{_RUN}" x="',
    f"'-{_RUN}-'",
    f'"-{_RUN}-"',
    f'\\";{_RUN}//',
    f"\\u003cscript\\u003e{_RUN}\\u003c/script\\u003e",
    f"${{{_RUN}}} `{_RUN}`",
    f"\u2028{_RUN}\u2029",
    f"javascript:{_RUN}//",
    f"data:text/html,<script>{_RUN}</script>",
    f"vbscript:{_RUN}",
    "//evil.example/x",
    "https://evil.example/x",
    "{{7*7}}{% include 'x' %}{# x",
    "{{ self.__init__.__globals__ }}",
    f"&lt;script&gt;{_RUN}&lt;/script&gt;",
    f"&#60;script&#62;{_RUN}&#60;/script&#62;",
    f"%3Cscript%3E{_RUN}%3C/script%3E",
    f"+ADw-script+AD4-{_RUN}+ADw-/script+AD4-",
    f"\uff1cscript\uff1e{_RUN}\uff1c/script\uff1e",
    f"<\x00script>{_RUN}</script>",
    f"\x1b[31m\u202e<b>{_RUN}",
    "<a id=pageData></a><a id=viewer></a><form id=links name=students>",
    "__proto__",
    "constructor",
    "]](x) [x](javascript:alert(1)) ![x](//evil.example/x.png)",
    "=1+1 ##[error]y ::error::",
)


class AttackedClass(NamedTuple):
    """A class with one student for each attack: the folders of the submissions, the gradebook, the exported pages."""

    folders: tuple[Path, ...]
    book: Path
    pages: Path


def make_attacked_class(top: Path) -> AttackedClass:
    """Grade a class with each attack in the names, files, robots, answers, comments and marks of a student."""
    rows, folders = [["id", "name", "section"]], []
    for number, text in enumerate(ATTACKS):
        visible = text.replace("\0", "\x01")
        folders.append(top / "class" / f"{number} {visible.replace('/', chr(0x2215))}")
        write_submission(folders[-1], dict.fromkeys((*SLOTS, "box", "setup", "frame"), text))
        rows.append([folders[-1].name, visible, visible])
    (top / "class" / ATTACKS[7].replace("/", "\u2215")).with_suffix(".zip").write_bytes(b"no zip")
    with (top / "roster.csv").open("w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows(rows)
    with (top / "marks.csv").open("w", encoding="utf-8", newline="") as file:
        marks = [[row[0], "lidar-frame", "1", row[1]] for row in rows[1:]]
        csv.writer(file).writerows([["student", "criterion", "points", "comment"], *marks])
    book, pages = top / "book.db", top / "pages"
    for command in (
        ("batch", top / "class", "--gradebook", book, "--roster", top / "roster.csv"),
        ("mark", "--import", top / "marks.csv", "--by", ATTACKS[0], "--gradebook", book),
        ("export", "html", "--gradebook", book, "--output", pages),
    ):
        done = grader(*command)
        assert done.returncode == 0, done.stderr[-1000:]
    return AttackedClass((*folders,), book, pages)
