"""Show a robot on a page in the browser, which follows the files, until Ctrl-C."""

import gc
import json
import os
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from http import HTTPStatus
from pathlib import Path
from threading import Condition, Event, Thread, current_thread
from urllib.parse import quote

from grader.app.commands.repeating import changes, limited_time
from grader.app.commands.viewed_robots import ViewedFiles, ViewedRobot, ViewRequest, read_robots
from grader.app.commands.watch import files_to_watch
from grader.base.errors import GraderError
from grader.base.processor_time import GRADE_SECONDS, INSPECT_SECONDS
from grader.base.text import counted
from grader.report.drawing.mesh_data import MeshStore
from grader.report.local_server import (
    LocalServer,
    Response,
    html_response,
    json_response,
    shown_until_interrupted,
)
from grader.report.pages.viewing import GraphViewing, ProblemCard, RobotLink, Viewing
from grader.report.writing import Terminal

_POLL = 0.05  # seconds between two looks at the files, at least
_PATIENCE = 10.0  # seconds after which a page that waits for a change asks again
_MAX_VALUE = 1000  # characters of an argument
MAX_LOG_BODY = 2 * 1024 * 1024  # bytes of JSON, in which a character of a log may take six
_NOT_FROM_PAGE = "this request is not from the page"
_GRAPH = "graph!"  # begins the address of a graph; in that of a robot ! is quoted
_NOT_FOUND = Response(b"not found\n", status=HTTPStatus.NOT_FOUND)


class RobotPages:
    """The application of the server: a page for each robot, and its meshes.

    Pages wait for the next version. Of a robot that ROS 2 does not load any more, the last one that
    it loads is shown.
    """

    def __init__(self) -> None:
        self.number = 0  # of the version
        self.is_ended = False
        self.link: Path | None = None  # the file that leads the browser to the first page
        self.tried: Mapping[str, str] = {}  # the arguments of xacro that a page gives
        self.log: bytes | None = None  # the output of a terminal that a page gives
        self._asked = Event()  # to read again at once
        self._changed = Condition()
        self._waiting: set[Thread] = set()
        self._store = MeshStore()
        self._loaded: dict[str, ViewedRobot] = {}  # the last that ROS 2 loads, by path
        self._paths: list[str] = []
        self._files = ViewedFiles((), (), ())
        self._error: GraderError | None = None

    def show(self, files: ViewedFiles | GraderError) -> None:
        """Show what was read, or why nothing could be read."""
        with self._changed:
            self.number += 1
            self._error = None
            if isinstance(files, GraderError):
                self._error = files
            else:
                self._files = files
                self._paths = sorted({*self._paths, *(robot.path for robot in files.robots)})
                for robot in files.robots:
                    if robot.is_loaded:
                        self._loaded[robot.path] = robot
            self._changed.notify_all()

    def wait(self, seconds: float) -> bool:
        """Wait until a page asks to read again, but not for longer; return whether it did."""
        is_asked = self._asked.wait(seconds)
        if is_asked:  # otherwise, what is asked from now on is for the next wait
            self._asked.clear()
        return is_asked

    def end(self) -> None:
        """Tell the pages that wait for a change that there will be none."""
        with self._changed:
            self.is_ended = True
            waiting = list(self._waiting)
            self._changed.notify_all()
        self._asked.set()
        for thread in waiting:
            thread.join(1.0)

    def __call__(self, path: Sequence[str], body: bytes | None) -> Response:
        """Return the response to a request."""
        if body is not None:
            return self._change("/".join(path), body)
        match path:
            case ("changes", number, address):
                return self._next(number, address)
            case ("mesh", address):
                data = self._store.data(address)
                return Response(data, "application/octet-stream") if data else _NOT_FOUND
            case (address,):
                if self.link:
                    with suppress(OSError):
                        self.link.unlink()
                page = self._page(address)
                return html_response(page) if page else _NOT_FOUND
        return _NOT_FOUND

    def _change(self, path: str, body: bytes) -> Response:
        """Return the response to what a page sends."""
        if path == "arguments":
            return self._try_arguments(body)
        return self._explain(body) if path == "log" else _NOT_FOUND

    def _next(self, number: str, address: str) -> Response:
        """Return the page of a robot as soon as there is another version than that of a number."""
        with self._changed:
            self._waiting.add(current_thread())
            self._changed.wait_for(lambda: self.is_ended or str(self.number) != number, _PATIENCE)
            self._waiting.discard(current_thread())
            if self.is_ended:
                return json_response(isEnded=True)
            is_same = str(self.number) == number
        page = "" if is_same else self._page(address)
        return json_response(page=page)

    def _page(self, address: str) -> str:
        """Return the page of a robot; of the first one for an empty address, empty without any.

        For the address of a graph, it is the page of the graph.
        """
        if address.startswith(_GRAPH):
            return self._graph(address)
        with self._changed:
            addresses = {_address(path): path for path in self._paths}
            path = addresses.get(address or _address(self._files.robots[0].path))
            if path is None:
                return ""
            now = next((robot for robot in self._files.robots if robot.path == path), None)
            is_loaded = not self._error and now is not None and now.is_loaded
            shown = self._loaded.get(path, now)
            graphs = self._files.graphs
            assert shown  # each path is that of a robot that was read
            if shown.meshes is not None:
                self._store.lend(shown.meshes)
            links = []
            for other in self._paths:
                links.append(RobotLink(_address(other), other, other == path))
            viewing = Viewing(
                self.number,
                _address(path),
                links,
                shown.arguments,
                self._files.notes,
                is_broken=not is_loaded,
                broken=self._broken(now) if shown is not now or self._error else (),
                store=self._store,
                meshes=shown.meshes,
                log=self._files.log,
                graph=_GRAPH if graphs and graphs.launches else "",
                playback=self._files.playback,
            )
            return shown.render(viewing)

    def _graph(self, address: str) -> str:
        """Return the page of the graph of a launch file; empty for another address."""
        with self._changed:
            number = self.number
            graphs = self._files.graphs
            robots = [RobotLink(_address(path), path, is_shown=False) for path in self._paths]
        if not graphs:
            return ""
        links = []
        shown = ""
        for place, path in enumerate(graphs.launches):
            own_address = f"{_GRAPH}{_address(path)}" if place else _GRAPH
            links.append(RobotLink(own_address, path, own_address == address))
            if own_address == address:
                shown = path
        if not shown:
            return ""
        return graphs.render(shown, GraphViewing(number, address, robots, links))

    def _broken(self, robot: ViewedRobot | None) -> Sequence[ProblemCard]:
        """Return what is wrong with a robot as the files are now."""
        if self._error:
            return [ProblemCard("error", line) for line in str(self._error).split("\n")]
        if not robot:
            return [ProblemCard("error", "No robot is read from this file any more.")]
        return robot.broken

    def _try_arguments(self, body: bytes) -> Response:
        """Read the robots again with arguments of xacro that a page gives."""
        sent = _sent(body)
        with self._changed:
            before = self.tried
            robots = [*self._files.robots, *self._loaded.values()]
            names = {field.name for robot in robots for field in robot.arguments}
            match sent:
                case {"do": "reset"}:
                    self.tried = {}
                case {"do": "try", "arguments": dict(values)} if values.keys() <= names and all(
                    isinstance(value, str) and len(value) <= _MAX_VALUE for value in values.values()
                ):
                    self.tried = {**self.tried, **values}
                case _:
                    return json_response(HTTPStatus.BAD_REQUEST, error=_NOT_FROM_PAGE)
            if self.tried != before:
                self._asked.set()
        return json_response()

    def _explain(self, body: bytes) -> Response:
        """Read the robots again, and explain an output of a terminal that a page gives."""
        match _sent(body):
            case {"do": "clear"}:
                log = None
            case {"do": "explain", "log": str(text)}:
                log = text.encode("utf-8", "replace") if text.strip() else None
            case _:
                return json_response(HTTPStatus.BAD_REQUEST, error=_NOT_FROM_PAGE)
        with self._changed:
            self.log = log
            self._asked.set()
        return json_response()


def _sent(body: bytes) -> object:
    """Return what a page sends; None for what is no JSON."""
    with suppress(ValueError, RecursionError):
        return json.loads(body)
    return None


def _address(path: str) -> str:
    """Return the address of the page of a robot, one step."""
    return quote(path, safe="", errors="backslashreplace")


def follow_files(
    request: ViewRequest, pages: RobotPages, own_paths: Collection[str] = ()
) -> Iterator[None]:
    """Show the robots at a path, and again after every change, until the pages are ended.

    Yield after each.

    Args:
        request: What is shown.
        pages: The pages of the robots.
        own_paths: The real paths of files that do not count as changes.

    Raises:
        GraderError: What cannot be read at first.
    """
    watched = [Path(request.path)]
    if request.rubric:
        watched = files_to_watch(request.path, request.rubric)
    for besides in changes(watched, own_paths, _POLL, pages.wait):
        if pages.is_ended:
            return
        try:
            with limited_time(GRADE_SECONDS if request.rubric else INSPECT_SECONDS):
                files = read_robots(request, pages.tried, pages.log)
        except GraderError as error:
            if not pages.number:
                raise
            pages.show(error)
        else:
            besides[:] = files.besides
            pages.show(files)
        yield


def view_in_browser(
    request: ViewRequest, port: int, terminal: Terminal, *, opens: bool = True
) -> str:
    """Serve the pages of the robots at a path until Ctrl-C, and return a summary.

    It `opens` the page in the browser.

    Raises GraderError for what cannot be read at first.
    """
    gc.enable()  # unlike other commands, this one may run for hours
    pages = RobotPages()
    pages.log = request.log
    with LocalServer(pages, port, MAX_LOG_BODY) as server:
        # Some browsers see the current folder, but no folder for temporary files.
        pages.link = Path(f"open-view-{server.port}.html")
        versions = follow_files(request, pages, {os.path.realpath(pages.link)})
        next(versions)
        serving = Thread(target=server.serve_forever, kwargs={"poll_interval": 0.05}, daemon=True)
        serving.start()
        ending = "it follows the files; Ctrl-C ends it"
        with shown_until_interrupted(server.url, pages.link, terminal, ending, opens=opens):
            for _ in versions:
                pass
        pages.end()
        server.shutdown()
        serving.join()
    return f"{counted(pages.number - 1, 'change')} shown\n"
