"""Headless Chromium for tests of pages."""

import json
import os
import re
import shutil
import subprocess


def chromium_program():
    return next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)


class Browser:
    """Headless Chromium, controlled by the DevTools protocol over two pipes."""

    def __init__(self, program, folder):
        to_child, self.write_end = os.pipe()
        self.read_end, from_child = os.pipe()

        def connect():  # the protocol's descriptors are 3 and 4
            os.dup2(to_child, 13)
            os.dup2(from_child, 14)
            os.dup2(13, 3)
            os.dup2(14, 4)

        self.process = subprocess.Popen(
            [program, "--headless=new", "--no-sandbox", "--disable-gpu", f"--user-data-dir={folder}",
             "--remote-debugging-pipe", "about:blank"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, preexec_fn=connect, pass_fds=(3, 4))
        os.close(to_child)
        os.close(from_child)  # so that reading ends when Chromium does
        self.buffer, self.count, self.events = b"", 0, []

    def receive(self):
        while b"\0" not in self.buffer:
            part = os.read(self.read_end, 1 << 16)
            if not part:
                raise RuntimeError("Chromium has ended")
            self.buffer += part
        message, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(message)

    def call(self, method, session=None, **params):
        self.count += 1
        message = {"id": self.count, "method": method, "params": params}
        if session:
            message["sessionId"] = session
        os.write(self.write_end, json.dumps(message).encode() + b"\0")
        while True:
            answer = self.receive()
            if answer.get("id") == self.count:
                return answer.get("result", answer)
            self.events.append(answer)

    def open(self, url):
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Runtime", "Log", "Page", "Network"):
            self.call(domain + ".enable", session)
        self.call("Page.navigate", session, url=url)
        loaded = lambda e: e.get("method") == "Page.loadEventFired" and e.get("sessionId") == session
        while not any(map(loaded, self.events)):
            self.events.append(self.receive())
        return session

    def complaints(self):
        """Uncaught errors, messages on the console and requests to a network."""
        for e in self.events:
            method, params = e.get("method"), e.get("params", {})
            if method == "Runtime.exceptionThrown":
                yield "exception: " + params["exceptionDetails"].get("text", "")
            if method == "Runtime.consoleAPICalled" or method == "Log.entryAdded":
                yield "console: " + json.dumps(params)[:300]
            if method == "Network.requestWillBeSent" and not re.match("file:|data:|about:", params["request"]["url"]):
                yield "network: " + params["request"]["url"][:100]
