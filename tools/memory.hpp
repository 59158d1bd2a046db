#pragma once

/// How the memory that a verb frees is kept for what comes next.

/// Blocks of the size of a channel go back to the system when they are freed, whichever thread freed them: else each
/// thread's own heap keeps the largest trace it has seen.
void give_memory_back();

/// Threads that come and go take their memory from two heaps, which keep what is freed: asking the system for it anew
/// takes a fifth of the time of an answer. To be called before the first thread begins.
void keep_memory();

/// All threads take their memory from one heap: where they seldom ask for any, as in fits, a heap for each of them only
/// costs 2 MB. To be called before the first thread begins.
void share_memory();
