/* main.c: the one place that knows every room: it hands core the methods that bodies can have, and contact between them. */
#include "contact/contact.h"
#include "core/commands.h"
#include "fem/body.h"
#include "mpm/body.h"

int main(int argc, char **argv) {
    static const ab_method methods[] = {{"material-points", mpm_create}, {"finite-elements", fem_create}, {"rigid", rigid_create}};
    return ab_command_main(argc, argv, methods, sizeof methods / sizeof *methods, contact_create);
}
