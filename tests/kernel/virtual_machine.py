"""Boots Debian's own kernel in an emulated machine, with a root file system that is made of this machine's programs.

Nothing of the machine that tests run on is needed but its files: no /dev/kvm, no kernel modules, no root.
"""
import os
import pathlib
import re
import shutil
import subprocess
import tarfile

MODULES = ("vhci-hcd", "usbhid", "hid-generic", "snd-aloop", "vcan", "can-raw", "virtio_pci", "virtio_blk")
BUSYBOX = "/bin/busybox"
# Of packages that are taken apart and not installed: what an installation would have.
UDEV_PACKAGES = ("udev", "libsystemd-shared")
SYSTEM_PATH = "/usr/sbin:/usr/bin:/sbin:/bin"


class Unavailable(Exception):
    """What the test needs cannot be had here; the message says what, and what to do."""


def run(*command, **options):
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True,
                          env={**os.environ, "LC_ALL": "C", "PATH": SYSTEM_PATH}, **options).stdout


def need(program, package):
    path = shutil.which(program, path=SYSTEM_PATH)
    if path is None:
        raise Unavailable(f"{program} is not there: install the package {package} (config/setup.sh --test does)")
    return path


def kernel_package():
    """The package that linux-image-amd64 stands for today: its name changes with every new kernel."""
    match = re.search(r"Depends: (linux-image-\S+)", run("apt-cache", "depends", "linux-image-amd64"))
    if match is None:
        raise Unavailable("apt knows no linux-image-amd64: run apt-get update")
    return match.group(1)


def unpacked(packages, cache):
    """The folder that these packages are unpacked in; downloads them from Debian's mirror the first time."""
    try:
        version = re.findall(r"Candidate: (\S+)", run("apt-cache", "policy", packages[0]))[0]
    except (IndexError, OSError, subprocess.CalledProcessError) as error:
        raise Unavailable(f"apt does not say which {packages[0]} there is: {error}") from error
    folder = cache / f"{packages[0]}_{version.replace(':', '_')}"
    if folder.is_dir():
        return folder
    making = cache / f"{folder.name}.part-{os.getpid()}"
    shutil.rmtree(making, ignore_errors=True)
    making.mkdir(parents=True)
    try:
        for package in packages:
            run("apt-get", "download", package, cwd=making)
        for archive in making.glob("*.deb"):
            run("dpkg", "-x", archive, making)
            archive.unlink()
    except subprocess.CalledProcessError as error:
        raise Unavailable(f"cannot download {' '.join(packages)} from Debian's mirror: {error.stderr.strip()}") from error
    try:
        making.rename(folder)
    except OSError:  # another test was faster
        shutil.rmtree(making, ignore_errors=True)
    return folder


class RootFileSystem:
    """A folder that becomes the machine's initial RAM disk."""

    def __init__(self, folder):
        self.root = pathlib.Path(folder)
        for name in "bin sbin dev etc lib proc run sys tmp root usr/bin usr/sbin usr/share/hwdata usr/share/misc var".split():
            (self.root / name).mkdir(parents=True)
        (self.root / "var/run").symlink_to("/run")
        (self.root / "usr/share/hwdata/usb.ids").touch()  # usbip looks names up in it
        shutil.copy(BUSYBOX, self.root / "bin/busybox")
        for applet in run(BUSYBOX, "--list").split():
            if applet != "busybox":
                (self.root / "bin" / applet).symlink_to("busybox")
        for name in ("modprobe", "ip"):
            (self.root / "sbin" / name).symlink_to("/bin/busybox")

    def add_file(self, source, target, executable=False):
        path = self.root / target.lstrip("/")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.unlink(missing_ok=True)
        shutil.copy(source, path)
        if executable:
            path.chmod(0o755)

    def add_program(self, source, target, library_folders=()):
        """A program with the shared libraries that it loads."""
        self.add_file(source, target, executable=True)
        self.add_libraries(source, library_folders)

    def add_libraries(self, source, library_folders=()):
        environment = {"LD_LIBRARY_PATH": ":".join(map(str, library_folders))} if library_folders else {}
        listing = subprocess.run(["ldd", str(source)], capture_output=True, text=True, check=False,
                                 env={**os.environ, **environment}).stdout
        for path in re.findall(r"(/\S+) \(0x", listing):
            # What comes from a package that was taken apart goes to where the loader looks.
            home = next((folder for folder in library_folders if path.startswith(str(folder))), None)
            target = "/usr/lib/x86_64-linux-gnu/" + os.path.basename(path) if home else path
            self.add_file(os.path.realpath(path), target)

    def add_folder(self, folder, without=()):
        shutil.copytree(folder, self.root / folder.lstrip("/"), ignore=shutil.ignore_patterns(*without))

    def add_modules(self, kernel_folder, names):
        """Kernel modules with those that they need."""
        version = next((kernel_folder / "lib/modules").iterdir()).name
        source = kernel_folder / "lib/modules" / version
        if not (source / "modules.dep").is_file():
            run("depmod", "-b", kernel_folder, version)
        for name in names:
            for path in re.findall(r"insmod (\S+)", run("modprobe", "-d", kernel_folder, "-S", version, "--show-depends", name)):
                self.add_file(path, "/lib/modules/" + path.split("/lib/modules/", 1)[1])
        for listing in ("modules.builtin", "modules.order"):
            self.add_file(source / listing, f"/lib/modules/{version}/{listing}")
        run("depmod", "-b", self.root, version)

    def pack(self, archive):
        names = "\n".join(sorted(str(path.relative_to(self.root)) for path in self.root.rglob("*")))
        with open(archive, "wb") as out:
            subprocess.run(["cpio", "--create", "--format=newc", "--owner=0:0", "--quiet"], input=names.encode(), stdout=out,
                           cwd=self.root, check=True)


def boot(kernel_folder, archive, disk, console, timeout_s):
    """Runs the machine until it switches itself off. What it writes to its disk, /dev/vda, is a tar archive.

    The processor is emulated, whatever /dev/kvm looks like: what is there in a machine that is itself emulated may hang.
    """
    with open(disk, "wb") as empty:
        empty.truncate(64 * 1024 * 1024)
    kernel = next((kernel_folder / "boot").glob("vmlinuz-*"))
    command = ["qemu-system-x86_64", "-M", "pc", "-accel", "tcg,thread=multi", "-cpu", "max", "-smp", "2", "-m", "1024",
               "-kernel", str(kernel), "-initrd", str(archive), "-append", "console=ttyS0 quiet panic=-1",
               "-drive", f"file={disk},format=raw,if=virtio", "-nographic", "-no-reboot", "-nodefaults",
               "-serial", "stdio"]
    with open(console, "wb") as log:
        try:
            subprocess.run(command, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT, timeout=timeout_s,
                           check=False)
        except subprocess.TimeoutExpired:
            pass  # what it said is told by whoever finds nothing on its disk


def take_results(disk, folder):
    """Unpacks what the machine left on its disk; False: nothing."""
    try:
        with tarfile.open(disk) as archive:
            archive.extractall(folder)
        return True
    except tarfile.TarError:
        return False
