"""Tables that studies write into pages of docs, between the lines `<!-- made by STUDY: begin -->` and `end`."""
import sys


def table(title, heads, rows):
    lines = [title, "", "| " + " | ".join(heads) + " |", "|" + " --- |" * len(heads)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def tables(lines):
    """Of each table in the lines: the number of its line of heads, and its cells, heads first."""
    found = []
    for k, line in enumerate(lines):
        if not line.startswith("|"):
            continue
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if k == 0 or not lines[k - 1].startswith("|"):
            found.append((k, []))
        found[-1][1].append(cells)
    return found


def keep_seconds(new, old):
    """The new text with the seconds of the old one, column `s` or `s, ...` of each table: figures of a machine with other work are no measure of time. A row without seconds then or now
    is taken as it is new. ValueError where the tables have not the same heads and rows."""
    lines = new.split("\n")
    mine, theirs = tables(lines), tables(old.split("\n"))
    if [t[1][0] for t in mine] != [t[1][0] for t in theirs] or [len(t[1]) for t in mine] != [len(t[1]) for t in theirs]:
        raise ValueError("the page has other tables: seconds cannot be kept")
    for (first, rows), (_, before) in zip(mine, theirs):
        seconds = [c for c, head in enumerate(rows[0]) if head == "s" or head.startswith("s, ")]
        for r in range(2, len(rows)) if seconds else ():
            if rows[r][0] != before[r][0]:
                raise ValueError(f"the page has '{before[r][0]}' in place of '{rows[r][0]}': seconds cannot be kept")
            for c in seconds:
                if rows[r][c] and before[r][c]:
                    rows[r][c] = before[r][c]
            lines[first + r] = "| " + " | ".join(rows[r]) + " |"
    return "\n".join(lines)


def finish(text, failures, page, begin, end, write):
    """Prints a study's text and, asked to, puts it into its page, with --keep-seconds but for its seconds; ends the study, with 1 where something failed."""
    print(text)
    if write:
        with open(page) as stream:
            whole = stream.read()
        first, last = whole.index(begin) + len(begin), whole.index(end)
        if "--keep-seconds" in sys.argv:
            text = keep_seconds(text, whole[first:last])
        with open(page, "w") as stream:
            stream.write(whole[:first] + "\n\n" + text + "\n" + whole[last:])
    for line in failures:
        print(f"FAILED: {line}", file=sys.stderr)
    sys.exit(1 if failures else 0)
