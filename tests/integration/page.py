#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""
Drives a page of `plot -o NAME.html` in headless Chromium, over its debugging pipe: page.py
functions PAGE PLOTS TRACK [SCREENSHOT], page.py listed PAGE TEXT, page.py zeros PAGE FACT..., or
page.py million PAGE [SCREENSHOT]. Prints `ok ...` or `FAIL ...` a check, and measured times; exit 1
where one failed.
"""
import base64
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time

READY_S, PAN_MS = 10.0, 150.0


class Browser:
    def __init__(self, folder):
        to_read, self.write = os.pipe()
        self.read, to_write = os.pipe()

        def pipes():  # Chromium reads from 3 and writes to 4
            os.dup2(to_read, 103)
            os.dup2(to_write, 104)
            os.dup2(103, 3)
            os.dup2(104, 4)

        self.process = subprocess.Popen(
            ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
             "--window-size=1300,800", f"--user-data-dir={folder}", "--remote-debugging-pipe",
             "about:blank"],
            preexec_fn=pipes, close_fds=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_read)
        os.close(to_write)
        self.rest, self.last, self.session, self.faults = b"", 0, None, []
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target,
                                 flatten=True)["sessionId"]
        self.call("Runtime.enable")
        self.call("Page.enable")

    def call(self, method, **parameters):
        self.last += 1
        message = {"id": self.last, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.write, json.dumps(message).encode() + b"\0")
        while True:
            while b"\0" not in self.rest:
                more = os.read(self.read, 1 << 20)
                if not more:
                    sys.exit("FAIL chromium has ended")
                self.rest += more
            text, self.rest = self.rest.split(b"\0", 1)
            answer = json.loads(text)
            if answer.get("method") == "Runtime.exceptionThrown":
                self.faults.append(json.dumps(answer["params"]["exceptionDetails"])[:400])
            if answer.get("id") == self.last:
                if "error" in answer:
                    sys.exit(f"FAIL {method}: {answer['error']}")
                return answer["result"]

    def js(self, expression):
        result = self.call("Runtime.evaluate", expression=expression, returnByValue=True,
                           awaitPromise=True)
        if "exceptionDetails" in result:
            sys.exit(f"FAIL {expression}: {json.dumps(result['exceptionDetails'])[:400]}")
        return result["result"].get("value")

    def frames(self):
        self.js("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")

    def mouse(self, kind, x, y, **more):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def click(self, x, y):
        self.mouse("mouseMoved", x, y)
        for kind in "mousePressed", "mouseReleased":
            self.mouse(kind, x, y, button="left", clickCount=1)
        self.frames()

    def open(self, path):
        start = time.monotonic()
        self.call("Page.navigate", url="file://" + os.path.realpath(path))
        while not self.js("document.body && document.body.dataset.readyMs") and not self.faults:
            if time.monotonic() - start > 60:
                sys.exit("FAIL the page does not become ready")
            time.sleep(0.02)
        return time.monotonic() - start

    def screenshot(self, path):
        with open(path, "wb") as file:
            file.write(base64.b64decode(self.call("Page.captureScreenshot")["data"]))


failed = 0


def check(name, holds, detail=""):
    global failed
    print(("ok   " if holds else "FAIL ") + name + ("" if holds else f": {detail}"))
    failed += not holds


def middle_of(browser, selector):
    return browser.js(f"(box => [box.x + box.width / 2, box.y + box.height / 2])"
                      f"(document.querySelector('{selector}').getBoundingClientRect())")


def functions(browser, path, num_plots, track):
    browser.open(path)
    drawn = lambda: int(browser.js("document.body.dataset.plotsDrawn"))
    picture = lambda: browser.js("document.querySelector('#plots').toDataURL()")
    check("all plots are drawn", drawn() == num_plots, drawn())

    # a place on the line of the track that no other track lies over
    place = browser.js(f"""(() => {{
        const line = document.querySelector('#track-{track} .hit'), all = line.getTotalLength();
        for (let part = 0.05; part < 1; part += 0.05) {{
            const p = line.getPointAtLength(part * all).matrixTransform(line.getScreenCTM());
            if (document.elementFromPoint(p.x, p.y) === line) return [p.x, p.y];
        }}
    }})()""")
    browser.mouse("mouseMoved", *place)
    browser.frames()
    tip = browser.js("document.querySelector('#tip').textContent")
    check("a track under the pointer tells its history", tip.startswith(f"track {track}, ") and
          "speed: " in tip and "hits: " in tip and "score: " in tip, tip)
    check("no track is chosen", browser.js("document.querySelector('#track').hidden"))
    browser.click(*place)
    panel = browser.js("document.querySelector('#track').textContent")
    check("a click on a track shows its number", panel.startswith(f"track {track}, "), panel)
    check("and its history", browser.js("document.querySelectorAll('#track svg path').length") >= 4)

    whole, last = picture(), browser.js("document.querySelector('#now').textContent")
    browser.click(*middle_of(browser, "#time"))
    check("the slider moves the time",
          browser.js("document.querySelector('#now').textContent") != last)
    check("and the picture", picture() != whole and 0 < drawn() < num_plots, drawn())
    browser.js("document.querySelector('#window').value = 1;"
               "document.querySelector('#window').dispatchEvent(new Event('change'))")
    browser.frames()
    one_scan = drawn()
    check("plots of one scan", 0 < one_scan < num_plots / 4, one_scan)
    browser.click(*middle_of(browser, "#play"))
    at = browser.js("document.querySelector('#time').value")
    time.sleep(0.4)
    check("playback moves the slider", browser.js("document.querySelector('#time').value") > at or
          browser.js("+document.querySelector('#time').value") ==
          browser.js("+document.querySelector('#time').max"))

    browser.open(path)
    browser.click(*middle_of(browser, "#show-none"))
    of_tracks = drawn()
    check("plots of no track go", 0 < of_tracks < num_plots, of_tracks)
    browser.click(*middle_of(browser, "#show-track"))
    check("and those of tracks", drawn() < of_tracks, drawn())
    before = browser.js("document.querySelector('#world').getAttribute('transform')")
    browser.mouse("mouseWheel", *middle_of(browser, "#map"), deltaX=0, deltaY=-240)
    browser.frames()
    zoomed = browser.js("document.querySelector('#world').getAttribute('transform')")
    check("the wheel zooms", zoomed != before, zoomed)
    x, y = middle_of(browser, "#map")
    drag(browser, x, y, 60)
    check("a drag moves the map",
          browser.js("document.querySelector('#world').getAttribute('transform')") != zoomed)
    check("nothing is loaded from elsewhere",
          browser.js("performance.getEntriesByType('resource').length") == 0)


def drag(browser, x, y, by):
    """Milliseconds from each move of the mouse to the frame that shows it."""
    times = []
    browser.mouse("mousePressed", x, y, button="left", clickCount=1)
    for k in range(1, 13):
        browser.js("window.moved = new Promise(done => addEventListener('pointermove', () => {"
                   "const start = performance.now(); requestAnimationFrame(() =>"
                   "requestAnimationFrame(() => done(performance.now() - start)));}, "
                   "{once: true, capture: true})); 0")
        browser.mouse("mouseMoved", x + by * k / 12, y, button="left", buttons=1)
        times.append(browser.js("window.moved"))
    browser.mouse("mouseReleased", x + by, y, button="left", clickCount=1)
    return times


def million(browser, path, screenshot=None):
    ready_s = browser.open(path)
    check(f"ready in {READY_S:g} s ({ready_s:.2f} s)", ready_s <= READY_S, ready_s)
    x, y = middle_of(browser, "#map")
    pans = drag(browser, x, y, 120)
    pan_ms = statistics.median(pans)
    check(f"a pan below {PAN_MS:g} ms (median {pan_ms:.0f} ms, worst {max(pans):.0f} ms)",
          pan_ms < PAN_MS, pan_ms)
    check("a million plots are drawn",
          int(browser.js("document.body.dataset.plotsDrawn")) > 900000,
          browser.js("document.body.dataset.plotsDrawn"))
    if screenshot:
        browser.screenshot(screenshot)


def listed(browser, path, text):
    browser.open(path)
    found = browser.js("document.getElementById('unlisted').textContent")
    check("the list of tracks says what is not in it", found == text, found)


def zeros(browser, path, *lines):
    """A track's score of 0 is shown; heights that are 0 in all rows were not measured."""
    browser.open(path)
    browser.js("selectTrack(0)")
    browser.frames()
    rows = browser.js("Array.from(document.querySelectorAll('#track tr'), row => row.textContent)")
    for line in "score", "height":
        check(f"{line} of the track", [row for row in rows if row.startswith(line)] ==
              [text for text in lines if text.startswith(line)], rows)


with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
    chromium = Browser(folder)
    if sys.argv[1] == "functions":
        functions(chromium, sys.argv[2], int(sys.argv[3]), int(sys.argv[4]))
        if len(sys.argv) > 5:
            chromium.screenshot(sys.argv[5])
    elif sys.argv[1] == "listed":
        listed(chromium, *sys.argv[2:])
    elif sys.argv[1] == "zeros":
        zeros(chromium, *sys.argv[2:])
    else:
        million(chromium, *sys.argv[2:])
    check("no fault in the script", not chromium.faults, chromium.faults)
    chromium.session = None
    chromium.call("Browser.close")
    chromium.process.wait(20)
sys.exit(failed > 0)
