
/* clang reports loops by their lines in this file, also of the lookups above: the pragma of the loops ends after them. */
#ifdef UP_POP
#undef UP_POP
#if defined(__clang__)
#pragma clang diagnostic pop
#endif
#endif
