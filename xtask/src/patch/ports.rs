//! Edits of ports beside the main one: a host that gives no buffers for some of them hears the others.

use super::edit::{BUFFERS, CLAP_WRAPPER, Edit, WRAPPER, edit};

pub(super) const EDITS: &[Edit] = &[
    // The index one past the last port must give no port, and inputs are no outputs.
    edit(WRAPPER, "if aux_input_idx > data.numOutputs as usize {", "if aux_input_idx >= data.numInputs as usize {"),
    edit(WRAPPER, "if aux_output_idx > data.numOutputs as usize {", "if aux_output_idx >= data.numOutputs as usize {"),
    edit(
        CLAP_WRAPPER,
        "if aux_input_idx > process.audio_inputs_count as usize {",
        "if aux_input_idx >= process.audio_inputs_count as usize {",
    ),
    edit(
        CLAP_WRAPPER,
        "if aux_output_idx > process.audio_outputs_count as usize {",
        "if aux_output_idx >= process.audio_outputs_count as usize {",
    ),
    // The plugin is called even if it gets empty slices for some of these outputs.
    edit(
        WRAPPER,
        "                    for output_buffer_slice in
                        buffers.main_buffer.as_slice_immutable().iter().chain(
                            buffers
                                .aux_outputs
                                .iter()
                                .flat_map(|buffer| buffer.as_slice_immutable().iter()),
                        )
                    {",
        "                    for output_buffer_slice in buffers.main_buffer.as_slice_immutable() {",
    ),
    edit(
        CLAP_WRAPPER,
        "                for output_buffer_slice in buffers.main_buffer.as_slice_immutable().iter().chain(
                    buffers
                        .aux_outputs
                        .iter()
                        .flat_map(|buffer| buffer.as_slice_immutable().iter()),
                ) {",
        "                for output_buffer_slice in buffers.main_buffer.as_slice_immutable() {",
    ),
    // VST3 hosts give no pointers for the channels of a bus that is not active, but may give their number.
    edit(
        BUFFERS,
        "            crate::nice_debug_assert!(input_channel_pointers.is_some());
            match input_channel_pointers {
                Some(input_channel_pointers) => {
",
        "            match input_channel_pointers {
                Some(input_channel_pointers)
                    if (0..input_channel_pointers.num_channels).all(|channel_idx| unsafe {
                        !(*input_channel_pointers.ptrs.as_ptr().add(channel_idx)).is_null()
                    }) =>
                {
",
    ),
    edit(
        BUFFERS,
        "                None => {
                    for channel in input_storage.iter_mut() {",
        "                _ => {
                    for channel in input_storage.iter_mut() {",
    ),
    edit(
        BUFFERS,
        "                    match output_channel_pointers {
                        Some(output_channel_pointers) => {
                            crate::nice_debug_assert_eq!(
                                output_slices.len(),
                                output_channel_pointers.num_channels
                            );
",
        "                    match output_channel_pointers {
                        Some(output_channel_pointers)
                            if (0..output_channel_pointers.num_channels).all(|channel_idx| {
                                !(*output_channel_pointers.ptrs.as_ptr().add(channel_idx)).is_null()
                            }) =>
                        {
",
    ),
    edit(
        BUFFERS,
        "                            output_slices[output_channel_pointers.num_channels..]
                                .fill_with(|| &mut [])
                        }
                        None => {
                            crate::nice_debug_assert_eq!(output_slices.len(), 0);

                            // Same as above
",
        "                            output_slices[output_channel_pointers.num_channels..]
                                .fill_with(|| &mut [])
                        }
                        _ => {
",
    ),
];
