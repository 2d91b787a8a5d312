# SPDX-License-Identifier: Apache-2.0
"""Debian's kernel, from its package: the kernel of this machine has no video drivers, and may be no Debian one."""

import glob
import os
import re
import shutil
import subprocess
import tempfile

# What the virtual machine needs of the package, so that little is written to disk.
WANTED = ["./boot/vmlinuz-*"] + [
    f"./lib/modules/*/{path}"
    for path in ["modules.order", "modules.builtin*"]
    + [f"kernel/{folder}/*" for folder in ["drivers/virtio", "drivers/media", "net/9p", "fs/9p", "fs/netfs", "fs/fscache"]]
]


class Unavailable(Exception):
    """What is needed cannot be had on this machine; the text says why."""


def run(command, **options):
    """Its output; Unavailable with the last line of its complaint where it fails."""
    done = subprocess.run(command, capture_output=True, text=True, env={**os.environ, "LC_ALL": "C.UTF-8"}, **options)
    if done.returncode != 0:
        complaint = (done.stderr.strip() or done.stdout.strip()).splitlines()
        raise Unavailable(f"{command[0]} failed: {complaint[-1] if complaint else done.returncode}")
    return done.stdout


def package_name():
    """The package with the newest kernel of this Debian."""
    found = re.search(r"Depends: (linux-image-\S+-amd64)\b", run(["apt-cache", "depends", "linux-image-amd64"]))
    if not found:
        raise Unavailable("apt knows no package linux-image-amd64")
    return found.group(1) + "-unsigned"


def download(folder):
    """Fetches the package into the folder; with new package lists where the old ones do not do."""
    try:
        run(["apt-get", "-q", "download", package_name()], cwd=folder)
    except Unavailable:
        as_root = [] if os.geteuid() == 0 else ["sudo", "-n"]
        run([*as_root, "apt-get", "-q", "update"])
        run(["apt-get", "-q", "download", package_name()], cwd=folder)
    return glob.glob(os.path.join(folder, "*.deb"))[0]


class Kernel:
    """An unpacked kernel: its image, and the modules to insert."""

    def __init__(self, root):
        self.root = root
        self.image = glob.glob(os.path.join(root, "boot", "vmlinuz-*"))[0]
        self.version = os.path.basename(self.image).removeprefix("vmlinuz-")

    def modules_for(self, names):
        """Files of these modules and of all that they need, in the order in which to insert them."""
        files = []
        for name in names:
            shown = run(["modprobe", "-d", self.root, "-S", self.version, "--show-depends", name])
            for path in re.findall(r"^insmod (\S+)", shown, re.MULTILINE):
                if path not in files:
                    files.append(path)
        return files


def unpacked_kernel(cache):
    """The kernel in the folder `cache`; fetched if it is not there yet."""
    root = os.path.join(cache, "kernel")
    if not os.path.isdir(root):
        os.makedirs(cache, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=cache) as folder:
            package = download(folder)
            new = os.path.join(folder, "kernel")
            os.mkdir(new)
            with subprocess.Popen(["dpkg-deb", "--fsys-tarfile", package], stdout=subprocess.PIPE) as archive:
                run(["tar", "-x", "-C", new, "--wildcards", *WANTED], stdin=archive.stdout)
            run(["depmod", "-b", new, Kernel(new).version])
            shutil.move(new, root)
    return Kernel(root)
