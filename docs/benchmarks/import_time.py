#!/usr/bin/env python3
"""Imports scenes through libppm, one process each, and tells time and peak memory.

    import_time.py LIBPPM.so FILE...
"""
import ctypes
import os
import resource
import sys
import time


def import_file(library, path):
    ppm = ctypes.CDLL(library)
    context, scene = ctypes.c_void_p(), ctypes.c_void_p()
    assert ppm.ppm_context_create(None, ctypes.byref(context)) == 0
    assert ppm.ppm_scene_create(context, None, ctypes.byref(scene)) == 0
    before = resource.getrusage(resource.RUSAGE_SELF)
    begin = time.monotonic()
    status = ppm.ppm_scene_import(scene, path.encode(), None)
    seconds = time.monotonic() - begin
    after = resource.getrusage(resource.RUSAGE_SELF)
    busy = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    print("%s: status %d, %.2f s (%.2f s of processors), peak %.0f MB (%.0f MB before)" %
          (path, status, seconds, busy, after.ru_maxrss / 1024, before.ru_maxrss / 1024), flush=True)


def main():
    library, paths = sys.argv[1], sys.argv[2:]
    for path in paths:
        if os.fork() == 0:
            import_file(library, path)
            os._exit(0)
        os.wait()


if __name__ == "__main__":
    main()
