#!/usr/bin/env python3
"""tools/slurm on a real Slurm: a controller and two nodes on this machine. test.py <generate_dataset> <merge_dataset>

Needs slurmctld, slurmd, munged, and root: a node is a process namespace, so that killing it kills all that runs there.
"""

import getpass
import os
import pathlib
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "examples/common"))
from programs import digest

if len(sys.argv) < 3:
    print("generate_dataset and merge_dataset are not built")
    sys.exit(77)
GENERATOR, MERGE = sys.argv.pop(1), sys.argv.pop(1)
ROOT = pathlib.Path(__file__).resolve().parents[2]
SET = ["--recipe", "published", "--size", "256", "--count", "60", "--seed", "5"]
NEEDED = "slurmctld", "slurmd", "munged", "sbatch", "scontrol", "unshare"

CONFIGURATION = """\
ClusterName=test
SlurmctldHost={host}
SlurmctldPort={ports[0]}
SlurmUser={user}
AuthType=auth/munge
AuthInfo=socket={home}/munge.socket,cred_expire=6
CredType=cred/munge
StateSaveLocation={home}/state
SlurmdSpoolDir={home}/%n
SlurmctldPidFile={home}/slurmctld.pid
SlurmdPidFile={home}/%n.pid
SlurmdTimeout=10
ReturnToService=2
KillWait=2
MinJobAge=3600
JobRequeue=1
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SchedulerType=sched/backfill
SchedulerParameters=sched_interval=1,batch_sched_delay=0
SelectType=select/cons_tres
MpiDefault=none
NodeName=one NodeHostname={host} Port={ports[1]} CPUs=2
NodeName=two NodeHostname={host} Port={ports[2]} CPUs=2
PartitionName=all Nodes=one,two Default=YES MaxTime=INFINITE State=UP OverSubscribe=YES
"""


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for s in sockets:
        s.bind(("127.0.0.1", 0))
    ports = [s.getsockname()[1] for s in sockets]
    for s in sockets:
        s.close()
    return ports


class Cluster:
    """Slurm in a folder: started and stopped by this test, with its own configuration."""

    def __init__(self, home):
        self.home, self.processes = home, {}
        host = socket.gethostname().split(".")[0]
        for folder in "state", "one", "two":
            (home / folder).mkdir()
        (home / "munge.key").write_bytes(os.urandom(128))
        (home / "munge.key").chmod(0o400)
        (home / "slurm.conf").write_text(
            CONFIGURATION.format(host=host, home=home, ports=free_ports(3), user=getpass.getuser()))
        # Nothing uses control groups here; older versions have no `disabled`.
        (home / "cgroup.conf").write_text("CgroupPlugin=cgroup/v1\n")
        self.environment = os.environ | {"SLURM_CONF": str(home / "slurm.conf")}
        self.environment.pop("SLURM_ARRAY_TASK_ID", None)
        self.start("munged", "munged", "--foreground", "--force", f"--key-file={home}/munge.key",
                   f"--socket={home}/munge.socket", f"--pid-file={home}/munge.pid", f"--log-file={home}/munged.log",
                   f"--seed-file={home}/munge.seed")
        self.wait(lambda: (home / "munge.socket").exists(), 20)
        self.start("slurmctld", "slurmctld", "-D", "-i", "-f", home / "slurm.conf")
        for node in "one", "two":
            self.start_node(node)
        self.wait(self.both_idle, 60)

    def both_idle(self):
        return self.command("sinfo", "-h", "-t", "idle", "-o", "%D", check=False).strip() == "2"

    def start(self, name, *command):
        log = open(self.home / f"{name}.out", "ab")
        self.processes[name] = subprocess.Popen([*map(str, command)], env=self.environment, stdout=log, stderr=log,
                                                stdin=subprocess.DEVNULL, cwd=self.home)
        log.close()

    def start_node(self, node):
        self.start(node, "unshare", "--pid", "--fork", "--kill-child", "--mount-proc", "slurmd", "-D", "-N", node, "-f",
                   self.home / "slurm.conf")

    def kill_node(self, node):
        """The end of unshare ends slurmd, the first process of its namespace, and so all that runs there."""
        self.processes[node].kill()
        self.processes.pop(node).wait()

    def command(self, *words, check=True):
        result = subprocess.run([*map(str, words)], env=self.environment, capture_output=True, text=True, timeout=120,
                                cwd=self.home)
        assert not check or result.returncode == 0, result
        return result.stdout + (result.stderr if check else "")

    def wait(self, happened, seconds):
        end = time.monotonic() + seconds
        while not happened():
            if time.monotonic() > end:
                logs = "\n".join(f"== {path.name}\n{path.read_text()[-2000:]}" for path in self.home.glob("*.out"))
                raise TimeoutError(logs)
            time.sleep(0.2)

    def state(self, job):
        """States of a job's tasks, as a set."""
        words = self.command("scontrol", "show", "job", job, "-o", check=False).split()
        return {word.split("=")[1] for word in words if word.startswith("JobState=")}

    def stop(self):
        for name in list(self.processes):
            process = self.processes[name]
            if name in ("one", "two"):
                process.kill()
            else:
                process.terminate()
            try:
                process.wait(20)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


def reason_to_skip():
    missing = [name for name in NEEDED if not shutil.which(name)]
    if missing:
        return "missing: " + " ".join(missing)
    if os.geteuid() != 0:
        return "needs root, to start nodes"
    if subprocess.run(["unshare", "--pid", "--fork", "--mount-proc", "true"], capture_output=True).returncode != 0:
        return "process namespaces can't be made here"
    return None


@unittest.skipIf(reason_to_skip(), reason_to_skip())
class Slurm(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory(prefix="slurm")
        cls.addClassCleanup(cls.scratch.cleanup)
        cls.home = pathlib.Path(cls.scratch.name)
        programs = cls.home / "programs"
        programs.mkdir()
        for program in GENERATOR, MERGE:
            (programs / pathlib.Path(program).name).symlink_to(pathlib.Path(program).resolve())
        subprocess.run([GENERATOR, "--out", cls.home / "whole", *SET], check=True, stdout=subprocess.DEVNULL)
        cls.whole = digest(cls.home / "whole")
        cls.home.chmod(0o755)  # munge's socket is for every user
        (cls.home / "cluster").mkdir()
        cls.cluster = Cluster.__new__(Cluster)
        cls.addClassCleanup(lambda: cls.cluster.stop())
        cls.cluster.__init__(cls.home / "cluster")
        cls.cluster.environment["INSONIFY_PROGRAMS"] = str(programs)

    def submit(self, *words):
        text = self.cluster.command(ROOT / "tools" / "slurm", *words)
        name, array, merge_name, merge = text.split()
        self.assertEqual((name, merge_name), ("array", "merge"))
        return array, merge

    def test_an_array_and_its_merge_equal_one_run(self):
        out = self.home / "a"
        _, merge = self.submit(4, "--", "--out", out, *SET)
        self.cluster.wait(lambda: self.cluster.state(merge) == {"COMPLETED"}, 120)
        self.assertEqual(self.whole, digest(out))

    def test_a_failing_node_loses_no_image(self):
        out = self.home / "b"
        array, merge = self.submit(4, "--", "--out", out, *SET, "--size", 1024)
        self.cluster.wait(lambda: len(list(out.rglob("records/*/*.json"))) > 2, 60)
        running = self.cluster.command("squeue", "-h", "-w", "one", "-o", "%A", check=False).split()
        self.assertTrue(running)
        self.cluster.kill_node("one")
        self.cluster.wait(lambda: self.cluster.state(merge) == {"COMPLETED"}, 180)
        shown = self.cluster.command("scontrol", "show", "job", array, "-o")
        self.assertRegex(shown, r"Restarts=[1-9]")
        self.cluster.start_node("one")
        self.cluster.wait(self.cluster.both_idle, 60)
        subprocess.run([GENERATOR, "--out", self.home / "large", *SET, "--size", "1024"], check=True,
                       stdout=subprocess.DEVNULL)
        self.assertEqual(digest(self.home / "large"), digest(out))

    def test_a_merge_fails_while_a_shard_is_missing_and_tasks_completes_the_set(self):
        out = self.home / "c"
        _, merge = self.submit("--tasks", "0,2", 3, "--", "--out", out, *SET)
        # The set is empty while scontrol does not answer.
        self.cluster.wait(lambda: (state := self.cluster.state(merge)) and state <= {"FAILED", "COMPLETED", "CANCELLED"}, 120)
        self.assertEqual(self.cluster.state(merge), {"FAILED"})
        self.assertFalse((out / "annotations.json").exists())
        _, merge = self.submit("--tasks", "1", 3, "--", "--out", out, *SET)
        self.cluster.wait(lambda: self.cluster.state(merge) == {"COMPLETED"}, 120)
        self.assertEqual(self.whole, digest(out))


class Submission(unittest.TestCase):
    """Refusals and submitted commands, with a fake sbatch that records its arguments."""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        fake = self.folder / "sbatch"
        fake.write_text('#!/bin/sh\nprintf "%s\\n" "$@" "" >> "$SUBMITTED"\necho 17\n')
        fake.chmod(0o755)

    def submit(self, *words):
        environment = os.environ | {"PATH": f"{self.folder}:{os.environ['PATH']}", "INSONIFY_PROGRAMS": "/opt/my programs",
                                    "SUBMITTED": str(self.folder / "submitted")}
        return subprocess.run([ROOT / "tools" / "slurm", *map(str, words)], env=environment, capture_output=True,
                              text=True, cwd=self.folder)

    def test_sh_reads_the_submitted_words_as_they_were_given(self):
        # sbatch hands the text of --wrap to sh.
        out = "it's my s\u00e9t\t$HOME"
        self.assertEqual(self.submit(8, "--time=1", "--", "--out", out, "--count=9").stdout, "array 17 merge 17\n")
        first, second = (self.folder / "submitted").read_text().split("\n\n")[:2]
        self.assertIn("--array=0-7", first)
        self.assertIn("--time=1", first)
        self.assertIn("--dependency=afterok:17", second)
        generate = ["/opt/my programs/generate_dataset", "--threads", "1", "--count=9", "--out", f"{self.folder}/{out}",
                    "--shard", "8"]
        merge = ["/opt/my programs/merge_dataset", f"{self.folder}/{out}"]
        for submitted, expected in (first, generate), (second, merge):
            text = submitted.split("--wrap\nexec")[1]
            words = subprocess.run(["sh", "-c", r'printf "%s\n"' + text], capture_output=True, text=True, check=True).stdout
            self.assertEqual(words.splitlines(), expected)

    def test_invalid_arguments_are_refused_before_submitting(self):
        for reason, words in {"is not a number of shards": [0, "--", "--out", "a"], "-- and options of generate_dataset are missing": [3, "--out", "a"],
                              "--out FOLDER is missing": [3, "--", "--count", 4],
                              "--shard is set by this script": [3, "--", "--out", "a", "--shard", "1/3"],
                              "is not a list": ["--tasks", "x", 3, "--", "--out", "a"],
                              "--array=0 is set by this script": [3, "--array=0", "--", "--out", "a"]}.items():
            with self.subTest(reason):
                result = self.submit(*words)
                self.assertEqual(result.returncode, 2)
                self.assertIn(reason, result.stderr)
        self.assertFalse((self.folder / "submitted").exists())


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
