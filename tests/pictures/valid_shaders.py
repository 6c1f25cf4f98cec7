"""Every shader and every program of the viewer, judged as GLSL 3.30 core by glslangValidator: what one driver lets pass,
another refuses. Every shader also as GLSL 1.40 (OpenGL 3.1) and as GLSL ES 3.00 (a browser's WebGL 2).

    valid_shaders.py SOURCE_FOLDER      exit code 1 and the shader's file and line where something is wrong
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

VALIDATOR = "glslangValidator"
VERSION_LINE = "#version 330 core"
OTHER_VERSION_LINES = ["#version 140", "#version 300 es"]


def parts_of(room):
    """The names of the parts that shaders may include, in their order."""
    return re.search(r"^set\(parts ([\w/ ]+)\)", (room / "CMakeLists.txt").read_text(), re.MULTILINE)[1].split()


def expanded(file):
    """A shader's text with its parts, as viewer/gl/CMakeLists.txt puts it together."""
    text = file.read_text()
    shaders = file.parents[1]
    for line, part in enumerate(parts_of(shaders.parent), start=2):
        included = (shaders / f"{part}.part.glsl").read_text()
        text = text.replace(f'#include "{pathlib.Path(part).name}.part.glsl"\n', f"#line {line}0001\n{included}#line {line}\n")
    return text


def constant_of(file):
    """kGrassVert of grass.vert.glsl, as viewer/gl/CMakeLists.txt has it."""
    return "k" + "".join(word.capitalize() for word in re.split(r"[._]", file.name.removesuffix(".glsl")))


def programs_in(sources):
    """The names of programs, and of the constants that they are linked of."""
    call = re.compile(r'link_program\(\s*"([^"]+)",\s*(?:gl::)?shaders::(\w+),\s*(?:gl::)?shaders::(\w+)\)')
    for source in sources:
        yield from call.findall(source.read_text())


def passed(part, word):
    """What a shader takes (`in`) or gives (`out`): qualifier, type and name of each."""
    return set(re.findall(rf"^(flat |smooth |noperspective )?{word} (\w+) (\w+);", part.read_text(), re.MULTILINE))


def complaints_of(files, options=()):
    ended = subprocess.run([VALIDATOR, *options, *files], capture_output=True, text=True, check=False)
    return ended.stdout if ended.returncode != 0 else ""


def version_lines_of(folder):
    """Those that the viewer gives to drivers."""
    return set(re.findall(r'"(#version [^"]+)"', (folder / "viewer/gl/driver.cpp").read_text()))


def check_other_versions(wholes):
    """Complaints of shaders, in files that begin with VERSION_LINE, as each other version. Many at once: to begin is
    most of a validator's time."""
    complaints = []
    for line in OTHER_VERSION_LINES:
        with tempfile.TemporaryDirectory() as made:
            files = [pathlib.Path(made) / whole.name for whole in wholes]
            for file, whole in zip(files, wholes):
                file.write_text(whole.read_text().replace(VERSION_LINE, line, 1))
            if said := complaints_of(files):
                # After the name of each file, on a line of its own, stands what is wrong with it.
                blocks = [block.partition("\n") for block in re.split(rf"^{re.escape(made)}/", said, flags=re.MULTILINE)]
                wrong = [f"{name}.glsl: {text.strip()}" for name, _, text in blocks if text.strip()]
                complaints.append("\n".join([f"as {line}:", *wrong]))
    return complaints


def check(folder):
    shader_folder = folder / "viewer/gl/shaders"
    common = (shader_folder / "picture/common.glsl").read_text()
    complaints, parts = [], {}
    with tempfile.TemporaryDirectory() as made:
        for file in sorted(shader_folder.rglob("*.*.glsl")):
            if file.name.endswith(".part.glsl"):
                continue
            whole = pathlib.Path(made) / file.name.removesuffix(".glsl")
            whole.write_text(f"{VERSION_LINE}\n#line 10001\n{common}\n#line 1\n{expanded(file)}")
            parts[constant_of(file)] = whole
            if said := complaints_of([whole]):
                complaints.append(f"{file} (10001 is line 1 of common.glsl, 20001 and 30001 of the parts):\n{said}")
        complaints += check_other_versions(list(parts.values()))
        linked = set()
        for name, vertex, fragment in programs_in(sorted((folder / "viewer").rglob("*.cpp"))):
            linked |= {vertex, fragment}
            if said := complaints_of([parts[vertex], parts[fragment]], ["-l"]):
                complaints.append(f"program {name} of {vertex} and {fragment}:\n{said}")
            if missing := passed(parts[fragment], "in") - passed(parts[vertex], "out"):
                complaints.append(f"program {name}: {vertex} does not give what {fragment} takes: {sorted(missing)}")
        complaints += [f"{part.name}.glsl is in no program" for name, part in parts.items() if name not in linked]
    if other := version_lines_of(folder) - {VERSION_LINE, *OTHER_VERSION_LINES}:
        complaints.append(f"no judge for {sorted(other)}")
    if not parts:
        complaints.append(f"no shaders in {shader_folder}")
    return complaints


def main():
    if shutil.which(VALIDATOR) is None:
        sys.exit(f"{VALIDATOR} is not there: config/setup.sh --test installs it")
    complaints = check(pathlib.Path(sys.argv[1]))
    print("\n".join(complaints))
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
