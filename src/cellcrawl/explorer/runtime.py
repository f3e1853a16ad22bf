"""The few functions that Numba's arrays ask of its runtime, as LLVM text.

Memory is taken from the front of a heap that starts over when nothing lives in it: kernels hold
arrays only while they run.
"""

from __future__ import annotations

from typing import Final

# The record before an array's data: references, destructor, its argument, data, size
RUNTIME: Final = """
@heap_start = internal global i32 0
@heap_end = internal global i32 0
@heap_next = internal global i32 0
@heap_held = internal global i32 0

define void @heap(i32 %start, i32 %end) {
  store i32 %start, ptr @heap_start
  store i32 %start, ptr @heap_next
  store i32 %end, ptr @heap_end
  store i32 0, ptr @heap_held
  ret void
}

define internal ptr @take(i32 %size) noinline {
  %next = load i32, ptr @heap_next
  %grown = add i32 %size, 31
  %rounded = and i32 %grown, -16
  %after = add i32 %next, %rounded
  %end = load i32, ptr @heap_end
  %fits = icmp ule i32 %after, %end
  br i1 %fits, label %yes, label %no
no:
  call void @llvm.trap()
  unreachable
yes:
  store i32 %after, ptr @heap_next
  %held = load i32, ptr @heap_held
  %more = add i32 %held, 1
  store i32 %more, ptr @heap_held
  %place = inttoptr i32 %next to ptr
  ret ptr %place
}

declare void @llvm.trap()

define internal void @give() noinline {
  %held = load i32, ptr @heap_held
  %fewer = sub i32 %held, 1
  store i32 %fewer, ptr @heap_held
  %none = icmp eq i32 %fewer, 0
  br i1 %none, label %over, label %done
over:
  %start = load i32, ptr @heap_start
  store i32 %start, ptr @heap_next
  br label %done
done:
  ret void
}

define ptr @NRT_Allocate(i64 %size) {
  %short = trunc i64 %size to i32
  %place = call ptr @take(i32 %short)
  ret ptr %place
}

define void @NRT_Free(ptr %place) {
  call void @give()
  ret void
}

define ptr @NRT_MemInfo_alloc_aligned(i64 %size, i32 %align) {
  %short = trunc i64 %size to i32
  %whole = add i32 %short, 96
  %record = call ptr @take(i32 %whole)
  %place = ptrtoint ptr %record to i32
  %past = add i32 %place, 95
  %data = and i32 %past, -64
  %data_at = inttoptr i32 %data to ptr
  store i64 1, ptr %record
  %dtor = getelementptr {i64, ptr, ptr, ptr, i64}, ptr %record, i32 0, i32 1
  store ptr null, ptr %dtor
  %info = getelementptr {i64, ptr, ptr, ptr, i64}, ptr %record, i32 0, i32 2
  store ptr null, ptr %info
  %points = getelementptr {i64, ptr, ptr, ptr, i64}, ptr %record, i32 0, i32 3
  store ptr %data_at, ptr %points
  %bytes = getelementptr {i64, ptr, ptr, ptr, i64}, ptr %record, i32 0, i32 4
  store i64 %size, ptr %bytes
  ret ptr %record
}

define ptr @NRT_MemInfo_alloc_safe_aligned(i64 %size, i32 %align) {
  %record = call ptr @NRT_MemInfo_alloc_aligned(i64 %size, i32 %align)
  ret ptr %record
}

define void @NRT_MemInfo_call_dtor(ptr %record) {
  call void @give()
  ret void
}
"""
