// Empty: the target test_headers needs a source to precompile its headers for.
