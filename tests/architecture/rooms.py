"""The rooms of ARCHITECTURE.md, and who includes whom in the sources."""
import pathlib
import re

TOPS = ("engine", "drivers", "daemon", "viewer", "simulators")
TABLE_HEAD = "| room | what it is | may include | libraries |"
INCLUDE = re.compile(r'^\s*#\s*include\s*(?:"(?P<own>[^"]+)"|<(?P<outside>[^>]+)>)')


class Room:
    """One line of the table."""

    def __init__(self, name, may_include, libraries):
        self.name = name
        self.may_include = may_include
        self.libraries = libraries


def read_table(text):
    """The table of rooms in ARCHITECTURE.md's text: {name: Room}."""
    lines = iter(text.splitlines())
    if TABLE_HEAD not in lines:
        raise ValueError(f"ARCHITECTURE.md has no table that begins with {TABLE_HEAD}")
    next(lines)  # | --- |
    rooms = {}
    for line in lines:
        if not line.startswith("|"):
            break
        name, _, may_include, libraries = (cell.strip() for cell in line.strip("|").split("|"))
        rooms[name] = Room(name, may_include.split(), libraries.split())
    for room in rooms.values():
        named, room.may_include = room.may_include, set()
        for other in named:
            below = {r for r in rooms if other.endswith("/*") and r.startswith(other[:-1])} or {other}
            if not below <= rooms.keys():
                raise ValueError(f"{room.name} may include {other}, which is no room")
            room.may_include |= below - {room.name}
    return rooms


def includes_of(text):
    """Each #include line of a source: (line number, header, is it one of ours)."""
    for number, line in enumerate(text.splitlines(), 1):
        match = INCLUDE.match(line)
        if match:
            yield number, match["own"] or match["outside"], match["own"] is not None


def sources(root):
    """Paths of all C++ sources of the project's rooms, from its root."""
    for top in TOPS:
        for path in sorted((root / top).rglob("*")):
            if path.suffix in (".hpp", ".cpp", ".h", ".c") and path.is_file():
                yield path.relative_to(root)


def room_graph(root):
    """Which rooms each room includes: {room: {rooms}}."""
    graph = {}
    for path in sources(root):
        room = path.parent.as_posix()
        graph.setdefault(room, set())
        for _, header, is_own in includes_of((root / path).read_text(encoding="utf-8")):
            other = pathlib.PurePosixPath(header).parent.as_posix()
            if is_own and "/" in header and other != room:
                graph[room].add(other)
    return graph


def file_graph(root):
    """Which files each file includes, a header and its source taken as one: {stem: {stems}}."""
    graph = {}
    for path in sources(root):
        stem = path.with_suffix("").as_posix()
        included = graph.setdefault(stem, set())
        for _, header, is_own in includes_of((root / path).read_text(encoding="utf-8")):
            other = header.rsplit(".", 1)[0]
            if is_own and other != stem:
                included.add(other)
    return graph


def circle_in(graph):
    """Nodes that lead back to the first of them, or an empty list."""
    done = set()

    def walk(node, way):
        if node in way:
            return way[way.index(node):] + [node]
        if node in done:
            return []
        for other in sorted(graph.get(node, ())):
            circle = walk(other, way + [node])
            if circle:
                return circle
        done.add(node)
        return []

    for node in sorted(graph):
        circle = walk(node, [])
        if circle:
            return circle
    return []


def levels_of(graph):
    """Each node's height above those that include nothing, in a graph without circles: {node: level}."""
    levels = {}

    def level(node):
        if node not in levels:
            levels[node] = 1 + max((level(other) for other in graph.get(node, ())), default=-1)
        return levels[node]

    for node in graph:
        level(node)
    return levels
