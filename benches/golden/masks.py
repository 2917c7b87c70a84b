"""What two runs of the same numbers may differ in. Every mask says why it is there; everything else is compared."""

import re

TIME = rb"[\d.]+ (?:s|min|h|d)\b"
NUMBER = rb"[-+.\de]+"
DIGEST = rb"[0-9a-f]{64}"

# What a command is at, which it says on stderr only where that lasts more than 2 s.
PROGRESS = rb"|".join(
    (
        rb"loading the model",
        rb"reducing the model",
        rb"solving the tuned wheel",
        rb"finding the surrogates",
        rb"solving the patterns",
        rb"writing the tables",
        rb"choosing settings for the accepted error of \[accuracy\]",
        rb"fixed-interface modes of the sector",
        rb"harmonics and basis of the reduced model",
        rb"receptances and harmonics of the rows",
        rb"receptances of the tuned wheel with \d+ fixed-interface modes",
        rb"tuned wheel: load \d+ of \d+ \(.*\)",
        rb"[^:\n]+: \d+ of \d+ \S+ done",
        rb"\d+ of \d+ rows, .* failed",
    )
)


def without_times(match):
    """A sentence on one line without its times, whose lengths say where it is broken into lines."""
    return re.sub(TIME, b"TIME", b" ".join(match[0].split())) + b"\n"


def without_column(match):
    """A table without the numbers below `CPU ms`, which end where that head ends."""
    head, *rows = match[0].split(b"\n")
    end = head.index(b"CPU ms") + len(b"CPU ms")
    return b"\n".join([head, *(row[: end - len(b"CPU ms")] + b"  TIME" + row[end:] for row in rows)])


def stream(command, name, option=""):
    """Name of a stream of a command, with an option or with any."""
    return rf"^\d+\. (?:\d+ )?(?:{command})\b.*{option}.*: {name}$"


# Name of a file or stream, what is masked in it, and what takes its place.
MASKS = [
    # When a run began and how long it took, in its record.
    (r"/runs/\d+\.json$", rb'"(started_unix_s|wall_time_s)": ' + NUMBER, rb'"\1": TIME'),
    # The digest of a table of times.
    (r"/checksums\.json$", rb'("tradeoff_times\.parquet": \{\s+"digest": )"' + DIGEST, rb'\1"DIGEST'),
    # A stored JSON file ends in the digest of all before it, build and times among it.
    (r"\.json$", rb'"checksum": "' + DIGEST + rb'"\n\}\s*$', b'"checksum": "DIGEST"\n}'),
    # The digest of a reduced model is one of the build besides; this command stores no model that has it as its name.
    (stream("model", "stdout", "--json"), rb'"digest": "' + DIGEST, b'"digest": "DIGEST'),
    # Two commits can be of one build.
    (stream("--version", "stdout"), rb"\ncommit .*", b"\ncommit COMMIT"),
    # Rows per second of the last run.
    (stream("status", "stdout"), rb", [\d.]+ rows per second", b", NUMBER rows per second"),
    (stream("status", "stdout", "--json"), rb'"rows_per_second": ' + NUMBER, b'"rows_per_second": NUMBER'),
    # Times of the pilot of a plan, and the memory that the process had.
    (stream("plan", "stdout"), TIME, b"TIME"),
    (stream("plan", "stdout"), rb"a thread had \d+ %", b"a thread had NUMBER %"),
    (stream("plan", "stdout"), rb"memory about [\d.]+ MiB", b"memory about SIZE"),
    (
        stream("plan", "stdout", "--json"),
        rb'"(set_up_s|cpu_s_per_pattern|processor_share|wall_s|wall_lower_s|wall_upper_s|memory_bytes)": ' + NUMBER,
        rb'"\1": NUMBER',
    ),
    (
        stream("plan", "stdout", "--json"),
        rb'"cpu_s": \{\s+"value": %b,\s+"lower": %b,\s+"upper": %b' % (NUMBER, NUMBER, NUMBER),
        b'"cpu_s": {TIME',
    ),
    # The time that rows will take, as it is measured before they are solved.
    (
        stream("optimum|tradeoff", "stderr"),
        rb"(?s)rows;\s+about\s.*?\sby\s+the\s(?:[^\n]*\n)?[^\n]*(?:solved|two)\n",
        without_times,
    ),
    # The same once more, which is told only where rows take longer than a second.
    (stream("optimum", "stderr"), rb"the loads to solve: about [^:]*\sfirst\s+rows\n", b""),
    # Processor times of a row and of a surrogate.
    (stream("estimate", "stderr"), rb"measured: a row takes .*", b"measured: TIME"),
    # Processor times of settings.
    (stream("tradeoff", "stdout"), rb"(?m)^.* CPU ms.*(?:\n.+)*", without_column),
    (stream("tradeoff", "stdout", "--json"), rb'"cpu_s": ' + NUMBER, b'"cpu_s": NUMBER'),
    # Progress is told only where it takes long.
    (r": stderr$", rb"(?m)^(?:" + PROGRESS + rb")(?:, for \d+ s so far)?\n", b""),
]

# A reduced model. Its name is a digest, of the build among others, and it begins with one of name and content.
MODEL = re.compile(r"(?:^|/)model/([0-9a-f]{64})$")
DIGEST_BYTES = 32
# Processor times of the settings of a trade-off: nothing but clocks.
TIMES = "tradeoff_times.parquet"


def build_of(version):
    """The build that `--version` tells."""
    found = re.search(rb"^build ([0-9a-f]{32})$", version, re.MULTILINE)
    if not found:
        raise ValueError("--version tells no build")
    return found[1]


def masked(found, build):
    """Streams and files by their names, without what two runs or two builds may differ in."""
    words = {build: b"BUILD", **model_names(found)}
    return {
        replaced(name.encode(), words).decode(): masked_content(name, content, words) for name, content in found.items()
    }


def model_names(found):
    """Names of the reduced models that do not depend on the build: numbers in the order of their content."""
    models = [(name, match[1].encode()) for name in found if (match := MODEL.search(name))]
    models.sort(key=lambda model: found[model[0]][DIGEST_BYTES:])
    digests = dict.fromkeys(digest for _, digest in models)
    return {digest: b"MODEL%d" % number for number, digest in enumerate(digests)}


def masked_content(name, content, words):
    if MODEL.search(name):
        return content[DIGEST_BYTES:]
    if name.endswith(".parquet"):
        # No table has the build in it; one that has is to be seen.
        return b"" if name.endswith(TIMES) else content
    content = replaced(content, words)
    for where, what, instead in MASKS:
        if re.search(where, name):
            content = re.sub(what, instead, content)
    return content


def replaced(content, words):
    for old, new in words.items():
        content = content.replace(old, new)
    return content
