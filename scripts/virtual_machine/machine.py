# SPDX-License-Identifier: Apache-2.0
"""An emulated machine that sees this machine's files (read-only), one folder to write to, and virtual cameras."""

import os
import shutil
import subprocess
import time

from .kernel import Unavailable

TOOLS = ["qemu-system-x86_64", "cpio", "modprobe", "depmod", "dpkg-deb", "apt-get"]
BUSYBOX = "/bin/busybox"
SHARE = "/run/share"  # where the guest sees the folder
BEGIN, END = "=== guest begins", "=== guest ends with"

# /run is the only place where the guest can write; /tmp stays as it is, for what was built there.
INIT = """#!/bin/busybox sh
export PATH=/bin
/bin/busybox --install -s /bin
mount -t proc proc /proc
mount -t sysfs sys /sys
mount -t devtmpfs dev /dev
while read module; do insmod $module || echo "no module $module"; done </modules/order
insmod /modules/vivid.ko {vivid} || echo "no vivid"
mount -t 9p -o trans=virtio,version=9p2000.L,ro,cache=loose,msize=262144 host /host || echo "no host files"
for folder in dev proc sys; do mount --bind /$folder /host/$folder; done
mount -t tmpfs run /host/run
mkdir /host{share} /host/run/tmp
mount -t 9p -o trans=virtio,version=9p2000.L,msize=262144 share /host{share} || echo "no share"
echo "{begin}"
chroot /host /bin/sh {share}/guest.sh
echo "{end} $?"
sync
poweroff -f
"""


def require_tools():
    """Raises Unavailable, naming what must be installed."""
    os.environ["PATH"] += ":/usr/sbin:/sbin"  # depmod is there, and an ordinary user's PATH may not name it
    missing = [tool for tool in TOOLS if not shutil.which(tool)]
    if not os.path.exists(BUSYBOX):
        missing.append(BUSYBOX)
    if missing:
        raise Unavailable(f"{', '.join(missing)} missing; apt-get install qemu-system-x86 busybox-static cpio kmod")
    if subprocess.run(["ldd", BUSYBOX], capture_output=True).returncode == 0:
        raise Unavailable(f"{BUSYBOX} needs libraries; apt-get install busybox-static")


def initial_files(folder, kernel, vivid):
    """Writes the archive of files with which the guest starts; its path."""
    root = os.path.join(folder, "initial")
    for name in ["bin", "modules", "proc", "sys", "dev", "host"]:
        os.makedirs(os.path.join(root, name))
    shutil.copy(BUSYBOX, os.path.join(root, "bin"))
    order = []
    for path in kernel.modules_for(["virtio_pci", "9pnet_virtio", "9p", "vivid"]):
        shutil.copy(path, os.path.join(root, "modules"))
        if os.path.basename(path) != "vivid.ko":
            order.append("/modules/" + os.path.basename(path) + "\n")
    with open(os.path.join(root, "modules", "order"), "w") as file:
        file.writelines(order)
    init = os.path.join(root, "init")
    with open(init, "w") as file:
        file.write(INIT.format(vivid=vivid, share=SHARE, begin=BEGIN, end=END))
    os.chmod(init, 0o755)
    archive = os.path.join(folder, "initial.cpio")
    with open(archive, "wb") as out:
        names = subprocess.run(["find", "."], cwd=root, capture_output=True, check=True).stdout
        subprocess.run(["cpio", "-o", "-H", "newc", "--quiet"], cwd=root, input=names, stdout=out, check=True)
    return archive


def emulator(kernel, archive, share):
    """The command that starts the machine. KVM is not used: it hangs where it is nested."""
    return [
        "qemu-system-x86_64", "-accel", "tcg,thread=multi", "-cpu", "max", "-smp", "2", "-m", "1024",
        "-nographic", "-no-reboot", "-net", "none", "-kernel", kernel.image, "-initrd", archive,
        "-append", "console=ttyS0 quiet panic=-1",
        "-virtfs", "local,path=/,mount_tag=host,security_model=none,readonly=on,multidevs=remap",
        "-virtfs", f"local,path={share},mount_tag=share,security_model=none",
    ]  # fmt: skip


def run_in_machine(kernel, folder, share, vivid, timeout_s, tell):
    """Runs guest.sh of the folder `share` in the machine; what it prints goes to `tell` line by line. Its exit code;
    None where the machine ended without one, or did not end in time."""
    command = emulator(kernel, initial_files(folder, kernel, vivid), share)
    deadline = time.monotonic() + timeout_s
    code = None
    with subprocess.Popen(
        ["timeout", "--kill-after=5", str(int(timeout_s)), *command],
        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace",
    ) as machine:  # fmt: skip
        begun = False
        for line in machine.stdout:
            line = line.rstrip()
            if line.startswith(END):
                code = int(line.removeprefix(END))
            elif begun and code is None:
                tell(line)
            begun = begun or line.endswith(BEGIN)
            if not begun and line.startswith("no "):
                tell(line)
    if code is None and time.monotonic() >= deadline:
        tell(f"the machine did not end within {timeout_s} s")
    return code
