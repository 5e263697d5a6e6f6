"""Makes a process lack what Python on Windows lacks, as far as Python runs without it elsewhere.

Where its folder is first on the path of modules, this is imported before anything else, in a process and in those that
it starts.
"""

import os
import select
import signal
import socket
import sys

MODULES = {"crypt", "curses", "fcntl", "grp", "nis", "ossaudiodev", "pty", "pwd", "readline", "resource", "spwd"}
MODULES |= {"syslog", "termios", "tty"}

ABSENT = [
    (os, ["fork", "forkpty", "register_at_fork", "getuid", "geteuid", "getgid", "getegid", "mkfifo", "mknod"]),
    (os, ["sched_getaffinity", "get_blocking", "set_blocking", "killpg", "setsid", "getpgid", "chown", "fchmod"]),
    (os, ["O_DIRECTORY", "O_NOFOLLOW", "O_ACCMODE"]),
    (signal, ["SIGHUP", "SIGALRM", "SIGKILL", "SIGPIPE", "alarm", "setitimer", "ITIMER_REAL", "pthread_sigmask"]),
    (select, ["poll", "epoll"]),
    (socket, ["AF_UNIX"]),
]


class Absent:
    """Finds none of these modules."""

    def find_spec(self, name, path=None, target=None):
        if name in MODULES:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)


sys.meta_path.insert(0, Absent())
for module in MODULES:
    sys.modules.pop(module, None)
for module, names in ABSENT:
    for name in names:
        if hasattr(module, name):
            delattr(module, name)
