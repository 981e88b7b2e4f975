"""Print what a launch file of a workspace connects, and what is wrong in the workspace."""

import sys

from grader.workspace.api import connections_in, open_workspace

opened = open_workspace(sys.argv[1], max_size=100_000_000, arguments={})
graph = opened.launch_graph(opened.launch_files()[0])
for connection in connections_in(graph):
    names = [graph.nodes[at].name for at in (connection.from_node, connection.to_node)]
    print(f"{connection.kind} {connection.name}: {names[0]} -> {names[1]}")
for problem in opened.package_problems():
    print(f"{problem.location.file_and_line}: {problem.label}: {problem.message}")
