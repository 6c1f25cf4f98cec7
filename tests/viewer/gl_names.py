"""Does the viewer use only what its oldest context has? Each name of OpenGL in viewer/ that is newer than 3.1 must be of
an extension that viewer/gl/driver.hpp demands, or its file must ask for the extension.

    gl_names.py SOURCE_FOLDER      exit code 1 and the file, line and name where one is not

Versions are those of Khronos's header of the core profile.
"""
import pathlib
import re
import sys

HEADER = pathlib.Path("/usr/include/GL/glcorearb.h")  # libgl-dev, on which libepoxy-dev depends
OLDEST = (3, 1)

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


def faults_of(path, text, of_version, demanded):
    faults = []
    for number, line in enumerate(text.splitlines(), start=1):
        for name in re.findall(r"\b(?:GL_\w+|gl[A-Z]\w*(?=\())", line.split("//")[0]):
            if NOT_OPENGL.fullmatch(name) or of_version.get(name, (9, 9)) <= OLDEST:
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
    faults = [fault for f in files for fault in faults_of(f.relative_to(folder), f.read_text(), of_version, demanded)]
    if len(of_version) < 1000 or not demanded or not files:
        faults.append(f"{len(of_version)} names in {HEADER}, {len(demanded)} extensions, {len(files)} files: too few")
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
    return faults


if __name__ == "__main__":
    complaints = check(pathlib.Path(sys.argv[1]))
    print("\n".join(complaints))
    sys.exit(1 if complaints else 0)
