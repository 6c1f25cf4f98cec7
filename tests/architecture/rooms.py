"""The rooms of the project, as their CMakeLists.txt declare them, and who includes whom in the sources."""
import pathlib
import re

TOPS = ("engine", "drivers", "daemon", "viewer", "simulators")
INCLUDE = re.compile(r'^\s*#\s*include\s*(?:"(?P<own>[^"]+)"|<(?P<outside>[^>]+)>)')
# yuragi_room(engine/wind SOURCES ... LINK ...), yuragi_program(yuragi LINK ...), target_link_libraries(yuragi_drivers PUBLIC ...)
DECLARATION = re.compile(r"\b(?P<command>yuragi_room|yuragi_program|target_link_libraries)\(\s*(?P<name>\S+)(?P<rest>[^()]*)\)")
LINK = re.compile(r"\b(?:LINK|PUBLIC|PRIVATE|INTERFACE)\b(?P<targets>.*)", re.DOTALL)

# How the headers of a library begin. One that is not here has none that a room includes.
HEADERS = {
    "Boost::headers": "boost/crc boost/lockfree boost/system boost/uuid",
    "CLI11::CLI11": "CLI",
    "PkgConfig::CRYPTO": "openssl",
    "PkgConfig::CURL": "curl",
    "PkgConfig::EPOXY": "epoxy",
    "PkgConfig::FFTW3": "fftw3.h",
    "PkgConfig::HIDAPI": "hidapi",
    "PkgConfig::IMGUI": "imgui backends/imgui",
    "PkgConfig::JPEG": "jpeglib.h",
    "PkgConfig::LIBLO": "lo",
    "PkgConfig::LIBMODBUS": "modbus",
    "PkgConfig::LIBUSB": "libusb",
    "PkgConfig::MOSQUITTO": "mosquitto.h",
    "PkgConfig::NATS": "nats",
    "PkgConfig::PNG": "png.h",
    "PkgConfig::PORTAUDIO": "portaudio",
    "PkgConfig::PROMETHEUS": "prometheus",
    "PkgConfig::STB": "stb",
    "PkgConfig::UMOCKDEV": "umockdev.h",
    "SQLite::SQLite3": "sqlite3.h",
    "TinyGLTF::TinyGLTF": "tiny_gltf.h",
    "date::date-tz": "date",
    "flatbuffers::flatbuffers": "flatbuffers pose_generated.h",
    "fmt::fmt": "fmt",
    "glfw": "GLFW",
    "glm::glm": "glm",
    "nlohmann_json::nlohmann_json": "nlohmann",
    "spdlog::spdlog": "spdlog",
    "tomlplusplus::tomlplusplus": "toml++",
    "yuragi_asio": "boost/asio boost/beast boost/system",
}


class Room:
    """A folder of sources. `links`: the rooms that it links; `may_include`: those, and what they link in turn;
    `libraries`: how the headers begin of the libraries that it links itself."""

    def __init__(self, name, links, may_include, libraries):
        self.name = name
        self.links = links
        self.may_include = may_include
        self.libraries = libraries


def target_of(room):
    return "yuragi_" + room.replace("/", "_")


def rooms_of(files):
    """The rooms that these CMakeLists.txt declare: {name: Room}. `files`: {folder: text}."""
    targets = {}  # what each target links
    names = {}  # the room of a target
    for folder, text in files.items():
        for match in DECLARATION.finditer(re.sub(r"#.*", "", text)):
            target = match["name"]
            if match["command"] == "yuragi_room":
                target = target_of(match["name"])
                names[target] = match["name"]
            elif match["command"] == "yuragi_program":
                target = target_of(folder)
                if target in names:
                    continue  # its main.cpp belongs to the room
                names[target] = folder
            linked = LINK.search(match["rest"])
            targets.setdefault(target, []).extend(linked["targets"].split() if linked else [])

    def reached_from(target, reached):
        for other in targets.get(target, ()):
            if other not in reached:
                reached.add(other)
                reached_from(other, reached)
        return reached

    rooms = {}
    for target, name in names.items():
        links = {names[other] for other in targets[target] if other in names} - {name}
        may_include = {names[other] for other in reached_from(target, set()) if other in names} - {name}
        libraries = [prefix for other in targets[target] for prefix in HEADERS.get(other, "").split()]
        rooms[name] = Room(name, links, may_include, libraries)
    return rooms


def read_rooms(root):
    return rooms_of(
        {
            path.parent.relative_to(root).as_posix(): path.read_text(encoding="utf-8")
            for top in TOPS
            for path in sorted((root / top).rglob("CMakeLists.txt"))
        }
    )


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
