"""Does the viewer use only what its oldest context has? Each name of OpenGL in viewer/ that is newer than 3.1 must be of
an extension that viewer/gl/driver.hpp demands, or its file must ask for the extension. And each name must be in OpenGL ES
3.0, too, which browsers have as WebGL 2, but in the files that a browser's viewer does without. What only a browser
runs (viewer/web) needs no more than that.

    gl_names.py SOURCE_FOLDER      exit code 1 and the file, line and name where one is not

Versions are those of Khronos's headers.
"""
import pathlib
import re
import sys

HEADER = pathlib.Path("/usr/include/GL/glcorearb.h")  # libgl-dev, on which libepoxy-dev depends
OLDEST = (3, 1)
ES_HEADER = pathlib.Path("/usr/include/GLES3/gl3.h")  # libgles-dev, on which libglfw3-dev depends by libgl1-mesa-dev
DESKTOP_FILES = {"viewer/gl/driver_reports.cpp", "viewer/gl/pass_clock.cpp"}
BROWSER_FOLDER = "viewer/web/"

# The extensions that have what is used of newer versions, for older contexts.
EXTENSION_OF = {
    "GL_ARB_instanced_arrays": r"glVertexAttribDivisor",
    "GL_ARB_sampler_objects": r"gl(Gen|Delete|Bind|Is)Samplers?|gl(Get)?SamplerParameter\w+",
    "GL_ARB_sync": r"gl(Fence|Wait|ClientWait|Delete)Sync|GLsync|GL_SYNC_\w+|GL_TIMEOUT_IGNORED",
    "GL_ARB_timer_query": r"glQueryCounter|glGetQueryObjectu?i64v|GL_TIMESTAMP|GL_TIME_ELAPSED",
    "GL_EXT_texture_filter_anisotropic": r"GL_\w+_ANISOTROPY_EXT",
    "GL_KHR_debug": r"glDebugMessage\w+|GL_DEBUG_\w+",
    "GL_KHR_robustness": r"glGetGraphicsResetStatus",
}
# Names of ours, and of extensions, not of OpenGL's.
NOT_OPENGL = re.compile(r"GL_(ARB|EXT|KHR)_[a-z_0-9]+|GL_TRUE|GL_FALSE")


def versions():
    """The first version that has each name."""
    found, version = {}, None
    for line in HEADER.read_text().splitlines():
        if begins := re.match(r"#ifndef GL_VERSION_(\d)_(\d)", line):
            version = (int(begins[1]), int(begins[2]))
        elif line.startswith("#ifndef GL_"):
            version = None  # an extension
        elif version is not None:
            for name in re.findall(r"\b(?:GL_[A-Z0-9_]+|gl[A-Z]\w+)\b", line):
                found.setdefault(name, version)
    return found


def names_of_es():
    return set(re.findall(r"\b(?:GL_[A-Z0-9_]+|gl[A-Z]\w+)\b", ES_HEADER.read_text()))


def names_in(text):
    """The number of its line, and each name of OpenGL."""
    for number, line in enumerate(text.splitlines(), start=1):
        for name in re.findall(r"\b(?:GL_\w+|gl[A-Z]\w*(?=\())", line.split("//")[0]):
            if not NOT_OPENGL.fullmatch(name):
                yield number, name


def es_faults_of(path, text, of_es):
    """What OpenGL ES 3.0 does not have; names of an extension for which the file asks are left out."""
    def is_asked_for(name):
        return any(re.fullmatch(names, name) and f'_extension("{e}")' in text for e, names in EXTENSION_OF.items())
    return [f"{path}:{number}: {name} is not in OpenGL ES 3.0" for number, name in names_in(text)
            if name not in of_es and not is_asked_for(name)]


def faults_of(path, text, of_version, demanded):
    faults = []
    for number, name in names_in(text):
        if of_version.get(name, (9, 9)) <= OLDEST:
            continue
        extension = next((e for e, names in EXTENSION_OF.items() if re.fullmatch(names, name)), None)
        if extension is None:
            faults.append(f"{path}:{number}: {name} is newer than OpenGL {OLDEST[0]}.{OLDEST[1]}")
        elif extension not in demanded and f'_extension("{extension}")' not in text:
            faults.append(f"{path}:{number}: {name} needs {extension}, for which nothing asks in this file")
    return faults


def check(folder):
    of_version = versions()
    demanded = re.findall(r'NeededExtension\{"(\w+)"', (folder / "viewer/gl/driver.hpp").read_text())
    files = sorted(f for f in (folder / "viewer").rglob("*.[ch]pp"))
    faults = [fault for f in files if not str(f.relative_to(folder)).startswith(BROWSER_FOLDER)
              for fault in faults_of(f.relative_to(folder), f.read_text(), of_version, demanded)]
    of_es = names_of_es()
    for f in files:
        if str(f.relative_to(folder)) not in DESKTOP_FILES:
            faults += es_faults_of(f.relative_to(folder), f.read_text(), of_es)
    if missing := [file for file in DESKTOP_FILES if not (folder / file).exists()]:
        faults.append(f"not there: {missing}")
    if len(of_es) < 500 or len(of_version) < 1000 or not demanded or not files:
        faults.append(f"{len(of_es)} names in {ES_HEADER}, {len(of_version)} in {HEADER}, {len(demanded)} extensions, {len(files)} files: too few")
    # The judge sees what it is to see.
    for line, count in [
        ("glDrawArraysInstanced(GL_TRIANGLES, 0, 3, 1);", 0),
        ("glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, 1, 0);", 1),
        ("glQueryCounter(1, GL_TIMESTAMP);", 2),
        ('if (epoxy_has_gl_extension("GL_ARB_timer_query")) glQueryCounter(1, GL_TIMESTAMP);', 0),
        ("glBindSampler(0, 1);", 0),
        ("glEnable(GL_DEPTH_CLAMP);", 1),
        ("glVertexAttribPointer(0, 4, GL_INT_2_10_10_10_REV, GL_TRUE, 4, nullptr);", 1),
    ]:
        if len(found := faults_of("a line", line, of_version, demanded)) != count:
            faults.append(f"{line}: {len(found)} faults in place of {count}")
    for line, count in [
        ("glDrawArraysInstanced(GL_TRIANGLES, 0, 3, 1);", 0),
        ("glTexBuffer(GL_TEXTURE_BUFFER, GL_R32F, 1);", 2),
        ("glDrawElementsBaseVertex(GL_TRIANGLES, 3, GL_UNSIGNED_INT, nullptr, 3);", 1),
        ("glTexParameterf(GL_TEXTURE_2D, GL_TEXTURE_MAX_ANISOTROPY_EXT, 2.0F);", 1),
        ('if (epoxy_has_gl_extension("GL_EXT_texture_filter_anisotropic")) use(GL_TEXTURE_MAX_ANISOTROPY_EXT);', 0),
    ]:
        if len(found := es_faults_of("a line", line, of_es)) != count:
            faults.append(f"{line}: {len(found)} faults of OpenGL ES in place of {count}")
    return faults


if __name__ == "__main__":
    complaints = check(pathlib.Path(sys.argv[1]))
    print("\n".join(complaints))
    sys.exit(1 if complaints else 0)
