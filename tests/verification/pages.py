"""Tables that studies write into pages of docs, between the lines `<!-- made by STUDY: begin -->` and `end`."""
import sys


def table(title, heads, rows):
    lines = [title, "", "| " + " | ".join(heads) + " |", "|" + " --- |" * len(heads)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def finish(text, failures, page, begin, end, write):
    """Prints a study's text and, asked to, puts it into its page; ends the study, with 1 where something failed."""
    print(text)
    if write:
        with open(page) as stream:
            whole = stream.read()
        first, last = whole.index(begin) + len(begin), whole.index(end)
        with open(page, "w") as stream:
            stream.write(whole[:first] + "\n\n" + text + "\n" + whole[last:])
    for line in failures:
        print(f"FAILED: {line}", file=sys.stderr)
    sys.exit(1 if failures else 0)
