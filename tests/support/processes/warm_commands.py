"""The command `vorotool`, and Python, in processes that begin with everything imported.

A server imports the package once, and forks a process for each command; what stands for the command in the path hands
it the arguments, the folder, the environment and the standard streams. The process that does the work is a process of
its own with its own streams and its own end: only the imports are those of the server.
"""

import atexit
import gc
import marshal
import os
import signal
import socket
import subprocess
import sys
import time
from contextlib import contextmanager, suppress
from pathlib import Path

CLIENT = """#!{python} -IS
import marshal, os, socket, sys
server = socket.socket(socket.AF_UNIX)
server.connect({address!r})
socket.send_fds(server, [b"+"], [0, 1, 2])
server.sendall(marshal.dumps(({kind!r}, sys.argv[1:], os.getcwd(), dict(os.environ))))
server.shutdown(socket.SHUT_WR)
code = server.recv(1)
os._exit(code[0] if code else 70)
"""
"""A program that has another process do its work, and ends as that one does; without the server, with code 70."""

LIBRARIES = ("PIL.Image", "orjson", "numpy", "shapely", "click.shell_completion", "pyogrio", "pandas", "pyarrow")
"""Further modules that commands and blocks need."""


@contextmanager
def warm_commands(folder):
    """Give a folder with the programs `vorotool` and `warm-python`, which takes a script as its only argument."""
    address = str(folder / "server")
    for name, kind in (("vorotool", "command"), ("warm-python", "script")):
        program = folder / name
        program.write_text(CLIENT.format(python=sys.executable, address=address, kind=kind))
        program.chmod(0o755)
    command = [sys.executable, str(Path(__file__).resolve()), address]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    server = subprocess.Popen(command, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    try:
        deadline = time.monotonic() + 300
        while not Path(address).exists():
            assert server.poll() is None
            assert time.monotonic() < deadline, "the server does not start"
            time.sleep(0.01)
        yield folder
    finally:
        server.kill()
        server.wait()


def _serve(address):
    """Import all, then fork for each that comes."""
    import importlib
    import pkgutil

    import vorotool

    for name in LIBRARIES:
        with suppress(ImportError):  # it is of an extra that is not there
            importlib.import_module(name)
    for name in (module.name for module in pkgutil.walk_packages(vorotool.__path__, "vorotool.")):
        if not name.endswith("__main__"):
            importlib.import_module(name)
    gc.freeze()
    path = sys.path[:]
    sys.path[:] = [each for each in path if "/tests" not in each]
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # nobody waits for those that wait for the others
    with socket.socket(socket.AF_UNIX) as listening:
        listening.bind(address + ".new")
        listening.listen(64)
        Path(address + ".new").rename(address)
        while True:
            client, _ = listening.accept()
            if os.fork() == 0:
                listening.close()
                work = _asked(client)
                if work is not None:
                    return work
            client.close()


def _asked(client):
    """Take what a client asks for; give it in the process that does it, and the exit code to the client in this one."""
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    _, streams, _, _ = socket.recv_fds(client, 1, 3)
    with client.makefile("rb") as told:
        work = marshal.load(told)
    child = os.fork()
    if child:
        for stream in streams:
            os.close(stream)
        _, status = os.waitpid(child, 0)
        code = os.waitstatus_to_exitcode(status)
        client.sendall(bytes([code if code >= 0 else 128 - code]))
        os._exit(0)
    for number, stream in enumerate(streams):
        os.dup2(stream, number)
        os.close(stream)
    client.close()
    return work


def _do(kind, arguments, folder, environment):
    os.chdir(folder)
    os.environ.clear()
    os.environ.update(environment)
    if kind == "command":
        from vorotool.__main__ import main

        sys.argv[:] = ["vorotool", *arguments]
        main()
    else:
        script = arguments[0]
        sys.argv[:] = ["-c"]
        sys.path.insert(0, "")
        main_module = type(sys)("__main__")
        sys.modules["__main__"] = main_module
        exec(compile(script, "<string>", "exec"), main_module.__dict__)


def _ended(error):
    """Exit code of a program that an exception ended; its traceback is printed, as it is by Python."""
    if not isinstance(error, SystemExit):
        sys.excepthook(type(error), error, error.__traceback__)
        return 1
    if error.code is None or isinstance(error.code, int):
        return error.code or 0
    sys.stderr.write(f"{error.code}\n")
    return 1


def _main():
    work = _serve(sys.argv[1])
    code = 0
    try:
        _do(*work)
    except BaseException as error:
        code = _ended(error)
    atexit._run_exitfuncs()
    for stream in (sys.stdout, sys.stderr):
        stream.flush()
    os._exit(code & 255)  # an end in which each module is taken apart takes longer than most commands


if __name__ == "__main__":
    _main()
