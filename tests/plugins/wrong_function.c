/* wrong_function.c: the symbol is a function that would have to be called, which is code of the plugin. */
int abut_plugin_v1(void);
__attribute__((visibility("default"))) int abut_plugin_v1(void) { return 1; }
