#!/usr/bin/env python3
"""Kills the generator at each system call that touches a file, or makes the call fail: faults_test.py <generate_dataset>

A preloaded library counts these calls in all threads. At the N-th one it kills the process (with half of a write done),
or makes it fail, alone or with all later ones. In every case the folder holds no record without its files, and the same
command then makes the bytes of an undisturbed run. INSONIFY_FAULTS: step from one N to the next (40; tools/test --full: 1).
"""

import errno
import hashlib
import json
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
from programs import digest

GENERATOR = sys.argv.pop(1)
STEP = int(os.environ.get("INSONIFY_FAULTS", "40"))

SHIM = r"""
#define _GNU_SOURCE
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>
static long setting(const char* name) { const char* text = getenv(name); return text ? atol(text) : 0; }
static long calls;
/* Whether this call is to fail. With SHIM_ERRNO, only calls that write are counted and fail; without, the process dies. */
static int strikes(int writes) {
    const long at = setting("SHIM_AT"), reason = setting("SHIM_ERRNO");
    if (reason != 0 && !writes) return 0;
    const long now = __sync_add_and_fetch(&calls, 1);
    if (at == 0 || now < at || (now > at && setting("SHIM_ONCE"))) return 0;
    if (reason == 0) return 1;
    errno = (int)reason;
    return 1;
}
static void die(void) { kill(getpid(), SIGKILL); for (;;) pause(); }
#define GUARD(writes, failed) if (strikes(writes)) { if (setting("SHIM_ERRNO") == 0) die(); return failed; }
#define NEXT(type, name) ((type)dlsym(RTLD_NEXT, name))
FILE* fopen(const char* path, const char* mode) {
    GUARD(mode[0] == 'w', NULL)
    return NEXT(FILE* (*)(const char*, const char*), "fopen")(path, mode);
}
FILE* fopen64(const char* path, const char* mode) { return fopen(path, mode); }
size_t fwrite(const void* bytes, size_t size, size_t count, FILE* to) {
    size_t (*next)(const void*, size_t, size_t, FILE*) = NEXT(size_t (*)(const void*, size_t, size_t, FILE*), "fwrite");
    if (to == stdout || to == stderr) return next(bytes, size, count, to);
    if (strikes(1)) {
        const size_t half = next(bytes, size, count / 2, to);
        fflush(to);
        if (setting("SHIM_ERRNO") == 0) die();
        errno = (int)setting("SHIM_ERRNO");
        return half;
    }
    return next(bytes, size, count, to);
}
int fclose(FILE* file) {
    if (strikes(0)) die();
    return NEXT(int (*)(FILE*), "fclose")(file);
}
int fsync(int file) { GUARD(1, -1) return NEXT(int (*)(int), "fsync")(file); }
int rename(const char* from, const char* to) { GUARD(1, -1) return NEXT(int (*)(const char*, const char*), "rename")(from, to); }
int link(const char* from, const char* to) { GUARD(1, -1) return NEXT(int (*)(const char*, const char*), "link")(from, to); }
int mkdir(const char* path, mode_t mode) { GUARD(1, -1) return NEXT(int (*)(const char*, mode_t), "mkdir")(path, mode); }
int remove(const char* path) { GUARD(0, -1) return NEXT(int (*)(const char*), "remove")(path); }
int unlinkat(int at, const char* path, int flags) { GUARD(0, -1) return NEXT(int (*)(int, const char*, int), "unlinkat")(at, path, flags); }
int open(const char* path, int flags, ...) {
    va_list list; va_start(list, flags); const mode_t mode = va_arg(list, mode_t); va_end(list);
    GUARD((flags & O_CREAT) != 0, -1)
    return NEXT(int (*)(const char*, int, ...), "open")(path, flags, mode);
}
int open64(const char* path, int flags, ...) {
    va_list list; va_start(list, flags); const mode_t mode = va_arg(list, mode_t); va_end(list);
    return open(path, flags, mode);
}
DIR* opendir(const char* path) { GUARD(0, NULL) return NEXT(DIR* (*)(const char*), "opendir")(path); }
int clock_gettime(clockid_t clock, struct timespec* time) {
    const int done = NEXT(int (*)(clockid_t, struct timespec*), "clock_gettime")(clock, time);
    if (setting("SHIM_CLOCK")) time->tv_sec += (random() & 1 ? 1 : -1) * (random() % 2000000000);
    return done;
}
__attribute__((destructor)) static void report(void) {
    const char* path = getenv("SHIM_COUNT");
    if (!path) return;
    FILE* file = NEXT(FILE* (*)(const char*, const char*), "fopen")(path, "w");
    fprintf(file, "%ld", calls);
    NEXT(int (*)(FILE*), "fclose")(file);
}
"""


@unittest.skipUnless(shutil.which("cc") and sys.platform == "linux", "needs a C compiler and a preloaded library")
class Faults(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        home = tempfile.TemporaryDirectory()
        cls.addClassCleanup(home.cleanup)
        cls.folder = pathlib.Path(home.name)
        source, cls.shim = cls.folder / "shim.c", cls.folder / "shim.so"
        source.write_text(SHIM)
        subprocess.run(["cc", "-shared", "-fPIC", "-o", cls.shim, source, "-ldl"], check=True)
        heights = bytes((x * y) % 251 for y in range(40) for x in range(40))
        (cls.folder / "look.pgm").write_bytes(b"P5 40 40 255\n" + heights)
        cls.options = ["--recipe", "published", "--size", "16", "--count", "3", "--format", "npy,webdataset", "--reference", cls.folder / "look.pgm",
                       "--threads", "2"]
        cls.run_with("whole")
        cls.whole = digest(cls.folder / "whole")

    @classmethod
    def run_with(cls, out, **settings):
        environment = os.environ.copy()
        if settings:
            environment |= {"LD_PRELOAD": str(cls.shim)} | {f"SHIM_{k.upper()}": str(v) for k, v in settings.items()}
        return subprocess.run([GENERATOR, "--out", cls.folder / out, *cls.options], env=environment, timeout=120,
                              capture_output=True, text=True)

    def calls(self, **settings):
        count = self.folder / "count"
        result = self.run_with("counted", count=count, **settings)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.whole, digest(self.folder / "counted"))
        shutil.rmtree(self.folder / "counted")
        return int(count.read_text())

    def check_rest(self, out):
        """Every existing record has its files, and the same command completes the set to the same bytes."""
        for record in (self.folder / out / "records").rglob("*.json"):
            for file in json.loads(record.read_text())["files"]:
                self.assertEqual(hashlib.sha256((self.folder / out / file["path"]).read_bytes()).hexdigest(),
                                 file["sha256"])
        result = self.run_with(out)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.whole, digest(self.folder / out))
        shutil.rmtree(self.folder / out)

    def test_killed_at_each_call(self):
        total = self.calls(at=0)
        self.assertGreater(total, 100)
        killed = 0
        for at in range(1, total + 1, STEP):
            count = self.folder / "count"
            if self.run_with("killed", at=at, count=count).returncode == -9:
                killed += 1
            else:  # the number of calls depends on thread timing: this run ended before the N-th
                self.assertLess(int(count.read_text()), at)
            self.check_rest("killed")
        self.assertGreater(killed, len(range(1, total + 1, STEP)) // 2)
        print(f"{killed} runs killed at {total} calls")

    def test_all_writes_fail_from_each_call_on(self):
        total = self.calls(at=0, errno=errno.EIO)
        failed = 0
        for reason in errno.ENOSPC, errno.EROFS, errno.EDQUOT, errno.EIO, errno.EMFILE:
            for at in range(1, total + 1, STEP):
                result = self.run_with("failed", at=at, errno=reason)
                if result.returncode != 0:
                    failed += 1
                    self.assertEqual(result.returncode, 1, result.stderr)
                    self.assertRegex(result.stderr, r"generate_dataset: \S")
                    self.assertIn(os.strerror(reason), result.stderr)
                self.check_rest("failed")
        self.assertGreater(failed, 5 * len(range(1, total + 1, STEP)) // 2)
        print(f"{failed} runs failed at {total} calls")

    def test_each_call_fails_once(self):
        total = self.calls(at=0, errno=errno.EIO)
        for at in range(1, total + 1, STEP):
            self.run_with("once", at=at, errno=errno.EIO, once=1)
            self.check_rest("once")

    def test_a_clock_jump_changes_no_byte(self):
        result = self.run_with("clock", clock=1)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.whole, digest(self.folder / "clock"))

    def test_a_missing_or_changed_reference_is_named(self):
        look = self.folder / "look.pgm"
        good = look.read_bytes()
        shutil.copytree(self.folder / "whole", self.folder / "looks")
        try:
            look.unlink()
            result = self.run_with("looks")
            self.assertNotEqual(result.returncode, 0)
            self.assertIn("look.pgm", result.stdout + result.stderr)
            look.write_bytes(good[:-1])
            self.assertIn("look.pgm", self.run_with("looks").stderr)
            look.write_bytes(good[:-1] + b"!")
            self.assertRegex(self.run_with("looks").stderr, "look.pgm was .*, is ")
        finally:
            look.write_bytes(good)
        self.assertEqual(self.whole, digest(self.folder / "looks"))

    def test_truncated_and_corrupted_files_are_repaired(self):
        chance = random.Random(4)
        for name in sorted(set(self.whole) - {"config.json"})[::max(1, STEP // 8)]:
            shutil.copytree(self.folder / "whole", self.folder / "torn")
            path = self.folder / "torn" / name
            data = path.read_bytes()
            at = chance.randrange(len(data))
            path.write_bytes(chance.choice((data[:at], data[:at] + bytes([data[at] ^ 1 << chance.randrange(8)]) + data[at + 1:],
                                            bytes(len(data)), data + b"\0")))
            result = self.run_with("torn")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(self.whole, digest(self.folder / "torn"), name)
            shutil.rmtree(self.folder / "torn")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
