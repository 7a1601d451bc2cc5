# SPDX-License-Identifier: MIT
"""The HTML page of the experiment: one table, one picture a scene."""
import html
import os
import urllib.parse

STYLE = """body{font:16px/1.5 system-ui,Helvetica,Arial,sans-serif;color:#222;max-width:72rem;
margin:2rem auto;padding:0 1rem}
h1{font-size:1.6rem}h2{font-size:1.2rem;margin-top:2.2rem;border-bottom:1px solid #ccc}
table{border-collapse:collapse;margin:1rem 0}
th,td{padding:.25rem .8rem;text-align:right;border-bottom:1px solid #eee}
th{border-bottom:2px solid #888}td.n,td.w{text-align:left}tr.first td{border-top:1px solid #888}
.oracle,.goal{color:#666}.missed{color:#b00020;font-weight:600}.met{color:#1a7f37}
figure{margin:1.5rem 0}img{max-width:100%;height:auto}figcaption{color:#555}"""

INTRODUCTION = """<p>Each scene is simulated with {runs} seeds from {seed}, tracked and scored
against the truth; figures are means &plusmn; standard errors. The oracle is a Kalman filter or IMM
that is told which plots are whose: a reference, not a bound. Goals of completeness, false tracks
and switches are bars: green ones are met within two standard errors, red ones are not. Delays are
in scans from a target's first visibility to its first track.</p>"""

CONSISTENCY = """<p>NEES (normalised estimation error squared) of place and velocity over what it
is where covariances are right: above 1 they are too small; and shares inside the ellipse of 95 %. A
track that coasts counts as that alone; else its target turns, or not.</p>"""

CAPTION = "Seed {seed}: plots grey, truth green, tracks blue, tracks without a target red."


def table(results, columns, rows_of):
    heads = "".join(f"<th>{html.escape(heading)}</th>" for _, heading, _, _, _ in columns)
    lines = [f"<table><tr><th>scene</th><th></th>{heads}</tr>"]
    for result in results:
        for label, cells in rows_of(result):
            classes = {None: "", True: "met", False: "missed"}
            texts = "".join(f'<td class="{classes[None if met is None else bool(met)]}">'
                            f"{html.escape(text).replace('+-', ' &plusmn; ')}</td>"
                            for text, met in cells)
            name = (f'<a href="#{urllib.parse.quote(result["name"])}">'
                    f'{html.escape(result["name"])}</a>' if label == "today" else "")
            lines.append(
                f'<tr class="{"first" if label == "today" else label}"><td class="n">{name}</td>'
                f'<td class="w">{label}</td>{texts}</tr>')
    return "\n".join(lines + ["</table>"])


def consistency_table(results, headings, consistency_rows):
    heads = "".join(f"<th>{html.escape(heading)}</th>" for heading in headings)
    lines = [f"<table><tr><th>scene</th><th></th><th>motion</th>{heads}</tr>"]
    for result in results:
        for number, (label, motion, cells) in enumerate(consistency_rows(result)):
            classes = {None: "", True: "met", False: "missed"}
            texts = "".join(
                f'<td class="{classes[None if held is None else bool(held)]}">{text}</td>'
                for text, held in cells)
            lines.append(
                f'<tr class="{label if number else "first"}"><td class="n">'
                f'{"" if number else html.escape(result["name"])}'
                f'</td><td class="w">{label}</td><td class="w">{motion}</td>{texts}</tr>')
    return "\n".join(lines + ["</table>"])


def alarm_table(alarms):
    lines = [
        "<table><tr><th>clutter</th><th>hours</th><th>wanted an hour</th><th>tracks</th>"
        "<th>an hour</th><th>of the wanted</th><th>95 %</th></tr>"
    ]
    for row in alarms:
        lines.append(
            f'<tr><td class="n">{html.escape(row["name"])}</td><td>{row["hours"]:.1f}</td>'
            f'<td>{row["wanted_per_hour"]:g}</td><td>{row["tracks"]}</td>'
            f'<td>{row["per_hour"]:.2f}</td>'
            f'<td class="{"met" if row["held"] else "missed"}">{row["ratio"]:.2f}</td>'
            f'<td>{row["ratio_low"]:.2f} to {row["ratio_high"]:.2f}</td></tr>')
    return "\n".join(lines + ["</table>"])


def write(path, results, alarms, longs, options, columns, rows_of, consistency):
    body = ["<h1>Real skies</h1>"]
    if results:
        body += [
            INTRODUCTION.format(runs=options.runs, seed=options.seed),
            table(results, columns, rows_of)
        ]
        for result in results:
            name = html.escape(result["name"])  # of a file, which may have any
            body.append(f'<h2 id="{name}">{name}</h2>')
            if result["about"]:
                body.append(f"<p>{html.escape(result['about'])}</p>")
            body.append(
                f'<figure><img src="{urllib.parse.quote(result["name"])}.png" '
                f'alt="Plan view of {name}">'
                f"<figcaption>{CAPTION.format(seed=options.seed)}</figcaption></figure>")
        body += ["<h2>Consistency</h2>", CONSISTENCY, consistency_table(results, *consistency)]
    if alarms:
        body += [
            "<h2>False tracks an hour</h2>",
            "<p>Scenes without targets; "
            "confirmed tracks that began after ten minutes of learning.</p>",
            alarm_table(alarms)
        ]
    if longs:
        from parts import endurance_hours
        hours = html.escape(endurance_hours.table(longs))
        body += ["<h2>Hour by hour</h2>", f"<pre>{hours}</pre>"]
    text = (
        f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        f"<title>rhotrack: real skies</title>\n"
        f"<style>{STYLE}</style></head><body>\n" + "\n".join(body) + "\n</body></html>\n")
    part = path.with_suffix(".html.part")
    part.write_text(text, encoding="utf-8")
    os.replace(part, path)
