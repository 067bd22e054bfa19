#if defined(__clang__)
#pragma clang diagnostic pop
#endif
