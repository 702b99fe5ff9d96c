"""Every sentence a user may read when something is wrong, by its stable code.

A code never changes its meaning and is never used again; its first digit says what it is about
(:data:`GROUPS`). To add one: a line in :data:`CATALOGUE`, and a case in tests/test_errors.py.
"""

from __future__ import annotations

from typing import NamedTuple


class Entry(NamedTuple):
    """A title for lists of codes, and the templates of the sentences."""

    title: str
    message: str
    allowed: str = ""
    hint: str = ""


GROUPS = {
    "LS1": "Files",
    "LS2": "report.toml",
    "LS3": "Tables",
    "LS4": "Numbers, units and uncertainties",
    "LS5": "Published values",
    "LS6": "Usage and outputs",
}
"""What codes are about, by how they begin."""

CATALOGUE: dict[str, Entry] = {
    "LS101": Entry(
        "no such folder", "no such folder: '{text}'", hint="'loopsheet new FOLDER' makes one to start from"
    ),
    "LS102": Entry("not a folder", "'{text}' is not a folder", "a folder that holds a report.toml"),
    "LS103": Entry(
        "no report.toml",
        "the folder has no report.toml",
        "a folder that holds a report.toml",
        "'loopsheet new FOLDER' makes a folder to start from",
    ),
    "LS104": Entry(
        "no such file", "no such file: '{text}'", "the name of a file in the report's folder", "{suggestion}"
    ),
    "LS105": Entry("not a file", "'{text}' is not a file", "a regular file in the report's folder"),
    "LS106": Entry(
        "unreadable file", "'{text}' cannot be read: {reason}", hint="check the permissions of the file"
    ),
    "LS107": Entry(
        "file outside the folder",
        "'{text}' leads out of the report's folder",
        "a relative path with forward slashes, without '..'",
        "copy the file into the folder, so that the report can be moved and repeated",
    ),
    "LS108": Entry("file too large", "'{text}' has {size} bytes", "at most {limit} bytes"),
    "LS109": Entry(
        "not UTF-8",
        "byte {offset} of the file (0x{byte}) is not UTF-8 text",
        "UTF-8, with or without a byte order mark",
        "save the file again as UTF-8 (in a spreadsheet: 'CSV UTF-8')",
    ),
    "LS110": Entry(
        "binary file",
        "the file holds a NUL byte, at byte {offset}: it is not text",
        "a text file in UTF-8",
        "save the file again as UTF-8 text (in a spreadsheet: 'CSV UTF-8')",
    ),
    "LS111": Entry("empty file", "the file is empty", "{allowed}"),
    "LS112": Entry(
        "control character", "the control character {text} is in the text", "printable text on one line"
    ),
    "LS113": Entry(
        "spreadsheet in place of text",
        "the file is {kind}, not a table in text",
        "comma-separated values (CSV) in UTF-8, with a decimal point",
        "open it there and save the sheet as 'CSV UTF-8'; then name that file in report.toml",
    ),
    "LS201": Entry("not TOML", "not TOML: {reason}", "TOML 1.0, https://toml.io", "{suggestion}"),
    "LS202": Entry("TOML too deep", "the file is nested too deeply", "the keys of a report, two levels deep"),
    "LS203": Entry("unknown key", "unknown key '{text}' in {table}", "{known}", "{suggestion}"),
    "LS204": Entry("missing key", "the key '{text}' is missing in {table}", hint="write {example}"),
    "LS205": Entry("wrong type", "'{text}' is {found}", "{wanted}", "write {example}"),
    "LS206": Entry(
        "number without quotes",
        "'{text}' is a bare number: its digits as printed would be lost",
        "the number as printed and its unit, in quotes",
        "write {text} = {example}",
    ),
    "LS207": Entry("unknown workbook", "no such workbook: '{text}'", "{known}", "{suggestion}"),
    "LS208": Entry(
        "unknown way of shortening", "'{text}' is no way to shorten a number", "{known}", "{suggestion}"
    ),
    "LS209": Entry("parameters do not fit together", "{reason}", hint="{known}"),
    "LS210": Entry(
        "no space before the unit",
        "no space between number and unit: '{text}'",
        "the number, a space, the unit",
        'write "{example}"',
    ),
    "LS211": Entry(
        "parameter without unit",
        "{name} has no unit: '{text}'",
        "a unit that converts to {unit}",
        'write the unit after a space, for example "{example}"',
    ),
    "LS213": Entry("workbook fails", "{text} cannot be used: {reason}", hint="{suggestion}"),
    "LS214": Entry(
        "code of the folder",
        "'{text}' is code that came with the folder, and nobody asked to run it",
        "'loopsheet build' and 'check' of the folder, which run it",
        "read it; then 'verify --run-workbook', or 'pytest --loopsheet-run-workbook', runs it too",
    ),
    "LS215": Entry(
        "unknown publisher",
        "by is '{text}'",
        "'source', if the published values are those of the workbook's own source",
        "leave it out if somebody else published them",
    ),
    "LS216": Entry(
        "one file for two tables",
        "'{text}' is the file of the {known} already",
        "a file of its own for each table of rows",
        "the columns of each table stand in its own file, with a row for each of its rows",
    ),
    "LS217": Entry(
        "unknown shape", "'{text}' is no shape of an error within limits", "{known}", "{suggestion}"
    ),
    "LS301": Entry(
        "missing column", "the column{text} missing", hint="add '{example}' to the first line{suggestion}"
    ),
    "LS302": Entry(
        "doubled column",
        "the column '{text}' is there twice",
        "each column once",
        "delete or rename one of them",
    ),
    "LS303": Entry("unknown column", "unknown column '{text}'", "{known}", "{suggestion}"),
    "LS304": Entry(
        "column without unit",
        "the column '{text}' does not name its unit",
        "a unit in square brackets, that converts to {unit}",
        "write the unit of its numbers behind it, such as '{example}'",
    ),
    "LS305": Entry(
        "malformed header",
        "not a column's name and unit: '{text}'",
        "a name and its unit in square brackets",
        "write '{example}'{suggestion}",
    ),
    "LS306": Entry(
        "wrong number of fields",
        "the row has {found}, the first line has {wanted}",
        "{wanted} fields",
        "{suggestion}",
    ),
    "LS307": Entry(
        "row widened by decimal commas",
        "the row has {found} fields, the first line has {wanted}: decimal commas? (rows like this: {count})",
        "a decimal point; the comma separates fields, or semicolons do in the whole file",
        "write 2.334, not 2,334",
    ),
    "LS308": Entry(
        "wrong separator",
        "the fields are separated by {text}",
        "commas between fields, or semicolons in a table of measurements, and a decimal point in numbers",
        "export the table again as comma-separated values, with a decimal point",
    ),
    "LS309": Entry("no header", "the first line holds numbers instead of the names of columns", "{known}"),
    "LS310": Entry("too few tests", "the table has {count}", "at least {least}, one for each {row}"),
    "LS311": Entry(
        "doubled test number",
        "{name} {text} is there twice, first in line {first}",
        "each number once",
        "give each {name} a number of its own",
    ),
    "LS312": Entry(
        "not the number of a row",
        "'{text}' is no number of a {name}",
        "a positive whole number such as 1, 2, 3",
        "{suggestion}",
    ),
    "LS313": Entry(
        "quote not closed",
        "the quote that opens here is never closed",
        'a field in quotes ends with a quote; a quote inside it is doubled ("")',
    ),
    "LS314": Entry(
        "stray quote",
        "a stray quote in '{text}'",
        'quotes around the whole field; a quote inside it is doubled ("")',
    ),
    "LS315": Entry(
        "empty line", "an empty line between the rows", "empty lines at the end only", "delete it"
    ),
    "LS316": Entry("too many columns", "the first line has {found} fields", "at most {wanted} columns"),
    "LS317": Entry(
        "column given and taken",
        "the column '{name}' is given here, and taken from another report",
        "one of both",
        "{suggestion}",
    ),
    "LS318": Entry(
        "numbers for words",
        "{name} has {what}, such as '{text}'",
        "words that are no numbers of rows; of groups the same for all rows that belong together",
        "put a letter before each number: S{text}",
    ),
    "LS319": Entry(
        "one group in two words",
        "{name} is '{text}', and '{other}' in line {line}: they differ in case, blanks or forms alone",
        "one word for all rows that belong together",
        "write '{other}'; two groups may differ in case if each has several rows, else in a letter or number",
    ),
    "LS320": Entry("title above names", "columns are named in line {line}", hint="delete what is above it"),
    "LS321": Entry(
        "no reason to leave a row out",
        "'{text}' under 'left out' says no reason, and whatever stands there leaves the {name} out",
        "a reason, such as: double bounce heard",
        "leave the field empty if the {name} takes part",
    ),
    "LS401": Entry(
        "not a number",
        "{name} is not a number: '{text}'",
        "digits with a decimal point, and an exponent such as e-3 if need be",
        "{suggestion}",
    ),
    "LS402": Entry(
        "decimal comma",
        "{name} has a decimal comma: '{text}'",
        "a decimal point, and no marks between thousands",
        "write '{example}'{thousands}",
    ),
    "LS403": Entry("empty cell", "{name} is empty", "{allowed}", "{suggestion}"),
    "LS404": Entry(
        "not finite",
        "{name} is not a finite number: '{text}'",
        "a finite number",
        "{suggestion}",
    ),
    "LS405": Entry(
        "number out of reach",
        "{name} has too many digits, or is too large or too small: '{text}'",
        "at most 100 characters; in SI, the number and its last digit between 1e-300 and 1e300",
    ),
    "LS406": Entry(
        "out of range",
        "{name} is out of range: '{text}'",
        "{allowed}",
        "check the sign, the decimal point and the unit {unit} that it is read in{beyond}",
    ),
    "LS407": Entry(
        "uncertainty negative",
        "{name} is negative: '{text}'",
        "a standard uncertainty of at least 0",
        "without the column, the uncertainty follows from the printed digits",
    ),
    "LS408": Entry(
        "point among decimal commas",
        "{name} has a {mark}: '{text}', where other numbers of the table have decimal commas",
        "decimal commas in the whole table, or decimal points, and no marks between thousands",
        "write '{example}'{thousands}",
    ),
    "LS409": Entry(
        "decimal comma or thousands",
        "{name} is '{text}': every comma in the numbers of this table may stand between thousands, too "
        "(numbers like this: {count})",
        "decimal points; or decimal commas, if one of them has more or fewer than three digits behind it",
        "write '{point}' or '{whole}', whichever is meant, and all others so",
    ),
    "LS421": Entry("unknown unit", "unknown unit '{text}'", "{known}", "{suggestion}"),
    "LS422": Entry(
        "wrong dimension",
        "{name} is in '{text}', which does not convert to {unit}",
        "{known}",
        "{suggestion}",
    ),
    "LS423": Entry(
        "unit with a zero of its own or a logarithm",
        "'{text}' is not a multiple of an SI unit",
        "degC and degF by themselves, and plain multiples: no dB",
        "{suggestion}",
    ),
    "LS424": Entry(
        "malformed unit",
        "not a unit: '{text}'",
        "units with *, /, spaces, parentheses and powers up to 12, such as m/s^2, m·s⁻² or N/m^(3/2)",
        "{suggestion}",
    ),
    "LS425": Entry(
        "ambiguous unit",
        "'{text}' follows a slash without parentheses: is it above or below the line?",
        "one meaning, such as J/(kg*K)",
        "put parentheses around what is below the line",
    ),
    "LS431": Entry(
        "not an uncertainty",
        "'{text}' is not understood as an uncertainty",
        "u = 0.02; U = 0.03, k = 2; +-0.1 rect (tri, arcsine); 0.5 % of reading + 2 digits; s = 0.02, n = 5; "
        "exact; scatter of a column; u = 0.02, min = 0 (or truncated); exponential; samples = mass.csv",
        "{suggestion}",
    ),
    "LS432": Entry(
        "limits of unknown meaning",
        "'{text}' does not say what it is",
        "a word behind it: rect, tri or arcsine for limits, 'normal, k = 2' for an expanded uncertainty",
        'plus_minus = "rect" in [uncertainty] says it once for all',
    ),
    "LS433": Entry(
        "stated twice", "the uncertainty of {name} is stated twice", "one statement", "{suggestion}"
    ),
    "LS434": Entry(
        "correlation out of reach",
        "{reason}",
        "correlation coefficients between -1 and 1 that can hold together",
        "{suggestion}",
    ),
    "LS435": Entry(
        "not a number of digits",
        "this is not how many digits an uncertainty may have",
        "digits = 1 or digits = 2",
        "more digits of an uncertainty would say nothing; values.json has all of them",
    ),
    "LS436": Entry(
        "not a table of draws",
        "{number} draws of {name} say nothing of its distribution",
        "{fewest} draws or more that are not all the same",
    ),
    "LS437": Entry(
        "nothing to take",
        "'{file}' {reason}",
        "{known}",
        "{suggestion}",
    ),
    "LS441": Entry(
        "not limits",
        "'{text}' is not understood as limits",
        "1.25 .. 1.35, 1.30 +- 0.05, <= 1.35 or >= 1.25, with a unit where the cell has one: 22 .. 24 um",
        "{suggestion}",
    ),
    "LS442": Entry(
        "not a decision rule",
        "'{text}' is not understood as a part of a decision rule",
        'guard = "U", "0.83 U", "0.2 um" or "0"; level = "95 %"',
        "{suggestion}",
    ),
    "LS501": Entry(
        "not an index",
        "not an index: '{text}'",
        "1-2 for a pair, 3 for a row or group by its number, or its word; nothing for a single number",
        "{suggestion}",
    ),
    "LS502": Entry("unknown expectation", "expect is '{text}'", "nothing, or 'differs'", "{suggestion}"),
    "LS504": Entry(
        "doubled published value",
        "{text} is there twice from '{source}', first in line {first}",
        "each value of a source once",
    ),
    "LS505": Entry("unknown cell", "the sheet has no cell '{text}'", "{known}", "{suggestion}"),
    "LS506": Entry("unknown index", "{name} has no index '{text}'", "{known}"),
    "LS507": Entry(
        "not a known difference",
        "recomputed is '{text}'",
        "what is published, an arrow, what is recomputed: 1.234 -> 1.258",
        "leave it empty: 'loopsheet check --accept FOLDER' writes it",
    ),
    "LS508": Entry(
        "no known difference",
        "{name} says what a known difference rests on, but expect is empty",
        "'differs' in the column 'expect', or nothing in both",
        "leave both empty if the value has to print the same",
    ),
    "LS509": Entry(
        "not told of a cell",
        "'{text}' is nothing that is told of a cell",
        "{known}; its value by its name alone",
        "write what is published of its uncertainty as it stands there, in quotes if it has a comma",
    ),
    "LS510": Entry(
        "measured and free", "'{text}' is measured: its digits count", hint="leave it out of free"
    ),
    "LS511": Entry(
        "published values of a row that is gone",
        "{file} has no {row}, of which there are {number} published values",
        "{known}",
        "a row that takes no part stays in its table, with the reason in a column 'left out'",
    ),
    "LS601": Entry(
        "output not writable",
        "'{text}' cannot be written: {reason}",
        "a folder that may be written",
        "choose another place (a build's is --out), or {suggestion}",
    ),
    "LS602": Entry(
        "output not a folder",
        "'{text}' is a file, not a folder",
        "a folder",
        "choose another name",
    ),
    "LS603": Entry(
        "folder not empty",
        "'{text}' is not empty",
        "a folder that does not exist yet, or an empty one",
        "nothing was written; choose another name",
    ),
    "LS604": Entry("unknown word", "unknown {kind} '{text}'", "{known}", "{suggestion}"),
    "LS605": Entry("program missing", "{kind} needs {text}, which is not installed", hint="install {known}"),
    "LS606": Entry(
        "no workbook",
        "report.xlsx cannot be made: {reason}",
        "{known}",
        "--to html,latex,json makes the report without it",
    ),
    "LS607": Entry(
        "not a result",
        "'{text}' is no result: {reason}",
        "a folder that 'loopsheet build' wrote, or the values.json of one",
        "'loopsheet build FOLDER --to json' writes a values.json",
    ),
    "LS608": Entry(
        "not a manifest",
        "'{text}' is no manifest: {reason}",
        "the manifest.json that 'loopsheet build' writes beside its outputs",
        "name the folder that 'loopsheet build' wrote; the default of its --out is FOLDER/out",
    ),
    "LS609": Entry(
        "not known what it was built from",
        "which folder '{text}' was built from is not known: {reason}",
        "a folder with a report.toml, after the output folder",
        "loopsheet verify {text} FOLDER",
    ),
    "LS610": Entry(
        "output not as it was built",
        "'{text}' {reason}",
        "the files that manifest.json lists, as they were built",
        "{suggestion}; 'loopsheet verify' tells what else is different",
    ),
    "LS611": Entry("not a date", "not a date: '{text}'", "a day of the calendar, YYYY-MM-DD", "{suggestion}"),
    "LS612": Entry(
        "not a licence",
        "not a licence: '{text}'",
        "an identifier of SPDX such as CC-BY-4.0, or an address that begins with https://",
    ),
    "LS613": Entry(
        "file not writable",
        "'{text}' cannot be written: {reason}",
        "a file that may be written, in a folder that may be written",
        "nothing was written; {suggestion}",
    ),
    "LS614": Entry("options that do not go together", "{reason}", hint="{known}"),
    "LS615": Entry(
        "no folder",
        "no FOLDER is named, and the working directory holds no report.toml",
        "a folder that holds a report.toml, or the word 'paper' for the shipped campaign",
        "name {known}; 'loopsheet new FOLDER' makes a folder to start from",
    ),
    "LS616": Entry(
        "two meanings",
        "'{text}' is the word for the shipped campaign, and a folder here",
        "./{text} for the folder",
        "for the shipped campaign, go to another working directory",
    ),
    "LS617": Entry("wrong command line", "{reason}", "{known}", "{suggestion}"),
    "LS618": Entry(
        "no design known",
        "how measurements for the workbook '{text}' are planned is not known",
        "a workbook that declares a design, as 'soft_impact' does for drop tests; no Method declares one",
        "'loopsheet budget CELL' tells how uncertain a number of what was measured is",
    ),
    "LS619": Entry(
        "cannot be planned",
        "this cannot be planned: {reason}",
        "measurements that follow the curve of those that were made, within what the workbook allows",
        "choose values nearer to those that were measured",
    ),
    "LS621": Entry(
        "another build",
        "another build writes into '{text}', still after {seconds} s",
        "one build at a time into a folder",
        "wait for it, or choose another folder with --out",
    ),
    "LS622": Entry(
        "the machine has no more",
        "the machine refuses: {reason}",
        "free space on the disk, memory, and files that may be open at once",
        "nothing was half-written; 'df', 'free' and 'ulimit -a' tell what is short",
    ),
    "LS623": Entry(
        "a file of something else",
        "'{text}' is there already, and is no '{what}'",
        "a file that does not exist yet, or one that this command has written",
        "nothing was written; choose another name",
    ),
    "LS624": Entry(
        "no impacts",
        "{text} has no impacts that a simulation could be held to: {reason}",
        "a campaign of drop tests: impact speeds v, restitutions e between 0 and 1, and a reduced mass m_red",
        "'loopsheet card --for list' tells what a card can be made for",
    ),
    "LS625": Entry(
        "a contact that cannot do it",
        "{text} cannot return what was measured: {reason}",
        "another code, another speed, or the law itself: --for table, c or python",
    ),
    "LS626": Entry(
        "folder of something else",
        "'{text}' holds what no build has written: {known}",
        "a folder that is empty or does not exist yet, or one that an earlier build has written",
        "nothing was written; choose another with --out, or delete it if a build lost its manifest.json",
    ),
    "LS627": Entry(
        "row left out",
        "there is no {text}: {row} is left out, {reason}",
        "a row that is not left out",
        "with that field empty it takes part again",
    ),
    "LS628": Entry(
        "output of another report",
        "'{text}' holds the report of {known}",
        "a folder that holds no report of another one",
        "choose another place with --out",
    ),
}
