/* scene_reference.c: writes docs/scene.md from the tables that check scenes. */
#include <math.h>
#include <string.h>

#include "core/scene.h"
#include "core/scene_keys.h"

static const char *type_name(const ab_key *key) {
    switch (key->type) {
    case AB_KEY_NUMBER: return "number";
    case AB_KEY_INTEGER: return "whole number";
    case AB_KEY_FLAG: return "true, false";
    case AB_KEY_WORD: return "word";
    case AB_KEY_NAME: return "name";
    case AB_KEY_TEXT: return "text";
    case AB_KEY_POINT: return "[x, y]";
    case AB_KEY_FORMULA:
        return key->variables == AB_VARIABLES_TXY       ? "formula of t, x, y"
               : key->variables == AB_VARIABLES_T_START ? "formula of t, X, Y"
                                                        : "formula of t";
    case AB_KEY_VECTOR:
        return key->variables == AB_VARIABLE_T          ? "[x, y], formulas of t"
               : key->variables == AB_VARIABLES_XY      ? "[x, y], formulas of x, y"
               : key->variables == AB_VARIABLES_TXY     ? "[x, y], formulas of t, x, y"
               : key->variables == AB_VARIABLES_T_START ? "[x, y], formulas of t, X, Y"
               : key->variables == AB_VARIABLES_MOTION  ? "[x, y], formulas of t, x, y, X, Y"
                                                        : "[x, y]";
    default: return "mapping or list";
    }
}

/* "`a`, `b`": the words that are there; those to come are named behind. */
static void write_words(FILE *stream, const char *words) {
    const char *between = "";
    for (int pass = 0; pass < 2; pass++) {
        for (const char *c = words; *c != '\0';) {
            const size_t n = strcspn(c, "|");
            if ((*c == '!') == (pass == 1)) {
                fprintf(stream, "%s`%.*s`", between, (int)(n - (*c == '!')), c + (*c == '!'));
                between = ", ";
            }
            c += n + (c[n] == '|');
        }
        if (pass == 0 && strchr(words, '!') != NULL) between = "; not yet: ";
    }
}

static void write_range(FILE *stream, const ab_key *key) {
    if (!(key->flags & AB_KEY_RANGE)) return;
    if (isfinite(key->min)) fprintf(stream, "%s %g", key->flags & AB_KEY_MIN_OPEN ? ">" : ">=", key->min);
    if (isfinite(key->min) && isfinite(key->max)) fprintf(stream, ", ");
    if (isfinite(key->max)) fprintf(stream, "%s %g", key->flags & AB_KEY_MAX_OPEN ? "<" : "<=", key->max);
}

static void write_key(FILE *stream, const ab_key *key) {
    fprintf(stream, "| `%s` | ", key->name);
    if (key->type == AB_KEY_WORD)
        write_words(stream, key->words);
    else
        fprintf(stream, "%s", type_name(key));
    fprintf(stream, " | %s | ", key->unit == NULL || strcmp(key->unit, "1") == 0 ? "" : key->unit);
    if (key->flags & AB_KEY_REQUIRED)
        fprintf(stream, "required");
    else if (key->initial != NULL && key->initial[0] != '\0')
        fprintf(stream, "%s", key->initial);
    fprintf(stream, " | ");
    write_range(stream, key);
    fprintf(stream, " | %s |\n", key->help);
}

static void write_section(FILE *stream, const ab_section *section) {
    fprintf(stream, "\n## %s\n\n%s\n", section->title, section->help);
    if (section->example != NULL) fprintf(stream, "\n```yaml\n%s```\n", section->example);
    fprintf(stream, "\n| key | value | unit | default | range | meaning |\n| --- | --- | --- | --- | --- | --- |\n");
    for (size_t k = 0; k < section->count; k++)
        if (section->keys[k].type != AB_KEY_LATER) write_key(stream, &section->keys[k]);
    if (section->more != NULL) fprintf(stream, "\nBesides: %s.\n", section->more);
    const char *between = "\nKnown, but not in this version yet: ";
    for (size_t k = 0; k < section->count; k++) {
        if (section->keys[k].type != AB_KEY_LATER) continue;
        fprintf(stream, "%s`%s` (%s)", between, section->keys[k].name, section->keys[k].help);
        between = ", ";
    }
    if (between[0] == ',') fprintf(stream, ".\n");
}

static void write_words_table(FILE *stream, const char *title, const char *help, const ab_words *words, bool units) {
    fprintf(stream, "\n## %s\n\n%s\n\n| word |%s meaning |\n| --- |%s --- |\n", title, help, units ? " unit |" : "", units ? " --- |" : "");
    for (size_t i = 0; i < words->count; i++) {
        fprintf(stream, "| `%s` | ", words->word[i].name);
        if (units) fprintf(stream, "%s | ", strcmp(words->word[i].unit, "1") == 0 ? "" : words->word[i].unit);
        fprintf(stream, "%s%s |\n", words->word[i].help, !units && ab_norm_needs_level(words->word[i].name) ? " (needs `level`)" : "");
    }
}

static const char opening[] =
    "# Scene files\n"
    "\n"
    "This page is written by `abut help scene` from the tables that check a scene; a test holds that it is up to date.\n"
    "A scene is one YAML file. `abut check SCENE` says everything that is wrong with it, each with its line and column, and exits 2.\n"
    "\n"
    "```yaml\n"
    "abut: 1\n"
    "title: Block that slides on a plane\n"
    "constants: {mu: 0.3, g: 9.81}\n"
    "gravity: [0, -g]\n"
    "time: {end: 1, cfl: 0.5}\n"
    "grid: {from: [0, -1], to: [8, 2], cell: 0.25, sides: {bottom: fixed}}\n"
    "materials:\n"
    "  rubber: {model: linear-elastic, E: \"2 MPa\", nu: 0.3, density: 1000}\n"
    "bodies:\n"
    "  plane: {method: material-points, material: rubber, shape: {box: [[0, -1], [8, 0]]}}\n"
    "  block: {method: material-points, material: rubber, shape: {box: [[1, 0], [2, 1]]}, velocity: [1, 0]}\n"
    "contact:\n"
    "  - {bodies: [block, plane], algorithm: multi-velocity, response: coulomb, friction: mu}\n"
    "monitors:\n"
    "  - {name: block_x, body: block, value: position.x}\n"
    "```\n"
    "\n"
    "## Numbers\n"
    "\n"
    "- A bare number is in SI: `1800`, `5e-4`, `.5`. Forms that programs read differently are refused: `0x10`, `1_000`, `010`, `inf`, "
    "`nan`.\n"
    "- A number with a unit is converted: `\"20 MPa\"`, `\"10 mm\"`, `\"1800 kg m-3\"`, `\"30 deg\"`. A unit of another dimension is an "
    "error. Units are those of UDUNITS-2.\n"
    "- An expression of `constants`, `pi` and `e`: `2*mu`, `\"a > 1 ? b : c\"`; quotes where YAML needs them. Functions: sin cos tan asin "
    "acos atan sinh cosh tanh asinh acosh atanh\n"
    "  atan2 log2 log10 log (natural) ln exp sqrt sign rint abs sum avg min max. `^` is the power; comparison, `&&`, `||` and `c ? a : b` "
    "as in C. An angle in an expression is in radians.\n"
    "- A formula may use `t` (s), or `x` and `y` (m), or `X` and `Y` (m, the place at the start), where the tables say so. A unit may "
    "follow an expression or a formula: `\"2*p "
    "MPa\"`.\n"
    "- `constants` may use those written above them. Their names must not be those of variables or functions.\n"
    "- Anchors and aliases of YAML work; merge keys (`<<`) and tags do not. A file has at most 16 MiB, 64 levels and 500000 values with "
    "its aliases written out.\n"
    "\n"
    "## --set\n"
    "\n"
    "`--set PATH=VALUE` changes one value before anything is checked: `--set constants.mu=0.2`, `--set contact[0].friction=0.1`, `--set "
    "bodies.block.fill.per_cell=16`,\n"
    "`--set 'grid.sides={bottom: roller}'`. VALUE is YAML. A key that the file does not have is added; a body or a material is not.\n";

void ab_scene_write_reference(FILE *stream) {
    fputs(opening, stream);
    for (size_t i = 0; ab_sections[i] != NULL; i++) write_section(stream, ab_sections[i]);
    write_words_table(stream, "Monitor values of a body",
                      "`body: NAME`. Besides, a state that the body's material declares, by name (`plastic_strain`, `back_stress.xy`).",
                      &ab_words_body_values, true);
    write_words_table(stream, "Monitor values of a contact", "`contact: i`.", &ab_words_contact_values, true);
    write_words_table(stream, "Monitor values of a boundary", "`boundary: i`.", &ab_words_boundary_values, true);
    write_words_table(stream, "Monitor values of the scene", "Without body and contact.", &ab_words_scene_values, true);
    write_words_table(stream, "over", "How the points of a body become one number. `mass` and `volume` are the body's own without it.",
                      &ab_words_over, false);
    write_words_table(stream, "norm", "The window is `from` to `to`. The error is divided by `scale`, or by the reference's own size.",
                      &ab_words_norms, false);
    write_words_table(stream, "Columns of history.csv", "Also of one body, as `block.kinetic`, but for t, step, dt and remainder.",
                      &ab_words_columns, true);
    write_words_table(stream, "Output fields", "`position` is always there. Besides, the states that materials declare, by name.",
                      &ab_words_fields, true);
}
